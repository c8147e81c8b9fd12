// SPDX-License-Identifier: Apache-2.0
// MuJoCo's kinematics as reference: every machine is written as MJCF and moved by MuJoCo.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <memory>

#include "kinfer/kinematics/frame_motion.hpp"
#include "laws/example_chains.hpp"
#include "laws/mujoco_model.hpp"
#include "laws/slow_chain.hpp"

namespace kinfer {
namespace {

std::string text(const Vec3& v) {
  return fmt::format("{:.17g} {:.17g} {:.17g}", v.x(), v.y(), v.z());
}

std::string placed_at(const Mat3& rotation, const Vec3& position) {
  const Quat q(rotation);
  return fmt::format("pos='{}' quat='{:.17g} {:.17g} {:.17g} {:.17g}'", text(position), q.w(), q.x(), q.y(), q.z());
}

/// The joint's axis line in the link's frame at rest.
struct Line {
  Vec3 axis = Vec3::UnitZ(), point = Vec3::Zero();
};

/// From a quarter turn or a shift of one metre, so that it holds for every convention.
Line joint_line(const Joint& joint, const laws::Mat4& rest) {
  const double move = rotates(joint.type) ? 90 * degree : 1.0;
  const laws::Mat4 moved = std::visit([&](const auto& l) { return laws::slow_link(l, joint.type, move); }, joint.link);
  const Mat3 rest_R = rest.topLeftCorner<3, 3>();
  const Vec3 shift = rest_R.transpose() * (moved - rest).topRightCorner<3, 1>();
  if (translates(joint.type)) return {shift, Vec3::Zero()};
  const Mat3 rotation = rest_R.transpose() * moved.topLeftCorner<3, 3>();
  const Vec3 axis =
      Vec3(rotation(2, 1) - rotation(1, 2), rotation(0, 2) - rotation(2, 0), rotation(1, 0) - rotation(0, 1)) / 2.0;
  return {axis, 0.5 * (shift + axis.cross(shift))};  // shift = (1 - rotation) point
}

std::string bodies(const Chain& chain, int parent) {
  std::string xml;
  for (int j = 0; j < static_cast<int>(chain.joints.size()); ++j) {
    const Joint& joint = chain.joints[j];
    if (joint.parent != parent) continue;
    const laws::Mat4 rest = std::visit([&](const auto& l) { return laws::slow_link(l, joint.type, 0.0); }, joint.link);
    xml += fmt::format("<body name='{}' {}>", j, placed_at(rest.topLeftCorner<3, 3>(), rest.topRightCorner<3, 1>()));
    xml += "<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>";
    if (has_position(joint.type)) {
      const Line line = joint_line(joint, rest);
      xml += fmt::format("<joint name='{}' type='{}' axis='{}' pos='{}'/>", j, rotates(joint.type) ? "hinge" : "slide",
                         text(line.axis), text(line.point));
    }
    xml += bodies(chain, j) + "</body>";
  }
  return xml;
}

std::string model_text(const Chain& chain) {
  const Pose base = chain.base.pose();
  return fmt::format(
      "<mujoco><compiler angle='radian'/><option gravity='0 0 0'/><worldbody>"
      "<body {}>{}</body></worldbody></mujoco>",
      placed_at(base.rotation, base.position), bodies(chain, -1));
}

class MujocoComparison : public testing::TestWithParam<Chain> {
 protected:
  const Chain& chain() const { return GetParam(); }

  void put(const mjModel& model, mjtNum* to, bool velocity, const VectorXd& reading_like) const {
    const VectorXd moved = joint_displacements(chain(), reading_like);
    for (int j = 0; j < static_cast<int>(chain().joints.size()); ++j) {
      const int joint = mj_name2id(&model, mjOBJ_JOINT, std::to_string(j).c_str());
      if (joint >= 0) to[velocity ? model.jnt_dofadr[joint] : model.jnt_qposadr[joint]] = moved[j];
    }
  }
};

TEST_P(MujocoComparison, FramesAndTheirMotionsAgree) {
  const auto model = laws::mujoco_model(model_text(chain()));
  ASSERT_TRUE(model);
  const std::unique_ptr<mjData, laws::MujocoFree> data(mj_makeData(model.get()));
  for (std::uint64_t k = 0; k < 20; ++k) {
    const VectorXd q = laws::random_q(chain(), Rng(1).stream(k)), qd = laws::random_q(chain(), Rng(2).stream(k)),
                   qdd = laws::random_q(chain(), Rng(3).stream(k));
    put(*model, data->qpos, false, q);
    put(*model, data->qvel, true, qd);
    put(*model, data->qacc, true, qdd);
    mj_inverse(model.get(), data.get());
    mj_rnePostConstraint(model.get(), data.get());
    const std::vector<FrameMotion> motions = joint_motions(chain(), q, qd, qdd);
    for (int j = 0; j < static_cast<int>(motions.size()); ++j) {
      const int body = mj_name2id(model.get(), mjOBJ_BODY, std::to_string(j).c_str());
      const Eigen::Map<const Vec3> position(data->xpos + 3 * body);
      const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> rotation(data->xmat + 9 * body);
      EXPECT_LT((motions[j].pose.position - position).norm(), 1e-12) << "joint " << j;
      EXPECT_LT((motions[j].pose.rotation - rotation).norm(), 1e-12) << "joint " << j;
      Eigen::Matrix<double, 6, 1> velocity, acceleration;  // angular above linear
      mj_objectVelocity(model.get(), data.get(), mjOBJ_XBODY, body, velocity.data(), 0);
      mj_objectAcceleration(model.get(), data.get(), mjOBJ_XBODY, body, acceleration.data(), 0);
      EXPECT_LT((motions[j].omega - velocity.head<3>()).norm(), 1e-11) << "joint " << j;
      EXPECT_LT((motions[j].velocity - velocity.tail<3>()).norm(), 1e-11) << "joint " << j;
      EXPECT_LT((motions[j].alpha - acceleration.head<3>()).norm(), 1e-10) << "joint " << j;
      EXPECT_LT((motions[j].acceleration - acceleration.tail<3>()).norm(), 1e-10) << "joint " << j;
    }
  }
}

std::vector<Chain> rigid_chains() {
  std::vector<Chain> chains;
  for (Chain& chain : laws::examples()) {
    for (Joint& joint : chain.joints) joint.compliance = 0.0;
    if (!chain.joints.empty()) chains.push_back(std::move(chain));
  }
  return chains;
}

INSTANTIATE_TEST_SUITE_P(every, MujocoComparison, testing::ValuesIn(rigid_chains()),
                         [](const auto& instance) { return laws::test_name(instance.param); });

}  // namespace
}  // namespace kinfer
