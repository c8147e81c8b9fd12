// SPDX-License-Identifier: Apache-2.0
// Written MJCF is read by MuJoCo, whose frames must be those of the chain.
#include "kinfer/io/robot/mjcf/mjcf.hpp"

#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"
#include "laws/mujoco_poses.hpp"

namespace kinfer {
namespace {

class WrittenMjcf : public testing::TestWithParam<Chain> {};

void expect_site(const mjModel& model, const mjData& data, const std::string& name, const Pose& pose) {
  const int site = mj_name2id(&model, mjOBJ_SITE, name.c_str());
  ASSERT_GE(site, 0) << name;
  const Pose found = laws::pose_at(data.site_xpos + 3 * site, data.site_xmat + 9 * site);
  EXPECT_LT((pose.position - found.position).norm(), 1e-9) << name;
  EXPECT_LT((pose.rotation - found.rotation).norm(), 1e-9) << name;
}

TEST_P(WrittenMjcf, GivesTheSameFramesAndToolTo1e9) {
  const Chain& chain = GetParam();
  const auto model = laws::mujoco_model(format_mjcf(chain));
  ASSERT_TRUE(model);
  const std::unique_ptr<mjData, laws::MujocoFree> data(mj_makeData(model.get()));
  for (std::uint64_t k = 0; k < 200; ++k) {
    const VectorXd q = laws::random_q(chain, Rng(1).stream(k));
    laws::set_positions(*model, *data, active_joint_names(chain), q);
    expect_site(*model, *data, "tool", forward(chain, q));
    const auto frames = joint_frames(chain, q);
    for (std::size_t j = 0; j < frames.size(); ++j) expect_site(*model, *data, chain.joints[j].name, frames[j]);
  }
}

std::vector<Chain> rigid_examples() {
  std::vector<Chain> chains = laws::examples();
  for (Chain& chain : chains)
    for (Joint& joint : chain.joints) joint.compliance = 0.0;
  return chains;
}

INSTANTIATE_TEST_SUITE_P(every, WrittenMjcf, testing::ValuesIn(rigid_examples()),
                         [](const auto& instance) { return laws::test_name(instance.param); });

/// Four bars of a parallelogram in the plane across z, closed at joint positions 0: a crank and a rocker on the base,
/// a coupler on the rocker.
Chain four_bars() {
  Chain chain;
  const auto bar = [&](const char* name, int parent, const Vec3& at) {
    Joint joint{.name = name, .parent = parent};
    joint.link = UrdfLink{.origin = {at, from_rpy(Vec3(0.0, 0.0, 0.3)), Vec3::Zero()}, .axis = Vec3::UnitZ()};
    chain.joints.push_back(joint);
  };
  bar("crank", -1, Vec3(0.5, 0.0, 0.0));
  bar("rocker", -1, Vec3::Zero());
  bar("coupler", 1, Vec3(0.4, 0.0, 0.1));
  const auto frames = joint_frames(chain, VectorXd::Zero(3));
  const Vec3 pin = frames[2] * Vec3(0.3, 0.1, 0.0);
  chain.closures = {{.name = "pin",
                     .first = 0,
                     .second = 2,
                     .point_in_first = frames[0].inverse() * pin,
                     .point_in_second = Vec3(0.3, 0.1, 0.0)}};
  return chain;
}

TEST(LoopMjcf, ALoopIsConnectedAtItsPointInBothBodies) {
  const Chain chain = four_bars();
  const auto model = laws::mujoco_model(format_mjcf(chain));
  ASSERT_TRUE(model);
  ASSERT_EQ(model->neq, 1);
  EXPECT_EQ(model->eq_type[0], mjEQ_CONNECT);
  const Eigen::Map<const Vec3> in_first(model->eq_data), in_second(model->eq_data + 3);
  EXPECT_LT((in_first - chain.closures[0].point_in_first).norm(), 1e-9);
  EXPECT_LT((in_second - chain.closures[0].point_in_second).norm(), 1e-9);
}

}  // namespace
}  // namespace kinfer
