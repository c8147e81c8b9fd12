// SPDX-License-Identifier: Apache-2.0
// MuJoCo as judge of a URDF file that was changed in place: its tool poses are those of the calibrated chain.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kinfer/geometry/random.hpp"
#include "kinfer/io/robot/patch/urdf_patch.hpp"
#include "kinfer/io/robot/urdf/urdf.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"
#include "laws/mujoco_model.hpp"

namespace kinfer {
namespace {

std::string link(const std::string& name) {
  return fmt::format(
      "  <link name='{}'>\n    <inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' "
      "iyz='0'/></inertial>\n  </link>\n",
      name);
}

std::string joint(const std::string& name, const char* type, const std::string& parent, const std::string& child,
                  const std::string& origin, const char* axis) {
  return fmt::format(
      "  <joint name='{}' type='{}'>\n    {}\n    <parent link='{}'/><child link='{}'/>\n    <axis xyz='{}'/>\n"
      "    <limit lower='-9' upper='9' effort='1' velocity='1'/>\n  </joint>\n",
      name, type, origin, parent, child, axis);
}

/// Four joints of both kinds, one without an origin, a fixed part between them, and a branch.
std::string branched_arm() {
  return "<?xml version='1.0'?>\n<robot name='arm'>\n  <mujoco><compiler fusestatic='false'/></mujoco>\n" +
         link("base") + link("a") + link("b") + link("c") + link("d") + link("tool") + link("side") +
         joint("j1", "revolute", "base", "a", "<origin xyz='0.1 0 0.3' rpy='0 0 0.5'/>", "0 0 1") +
         joint("j2", "revolute", "a", "b", "<origin rpy='1.2 0.1 -3' xyz='0 .1 .2'/>", "0 1 0") +
         joint("weld", "fixed", "b", "c", "<origin xyz='0.1 0.1 0' rpy='0 0.2 0'/>", "1 0 0") +
         joint("j3", "prismatic", "c", "d", "<origin xyz='0.3 0 0'/>", "1 -2 0.5") +
         joint("j4", "revolute", "d", "tool", "", "0.3 0.4 -0.8") +
         joint("branch", "revolute", "a", "side", "<origin xyz='0 0 1'/>", "1 0 0") + "</robot>\n";
}

Pose tool_in_mujoco(const mjModel& model, mjData& data, const Chain& chain, const VectorXd& q) {
  const std::vector<std::string> names = active_joint_names(chain);
  for (std::size_t k = 0; k < names.size(); ++k)
    data.qpos[model.jnt_qposadr[mj_name2id(&model, mjOBJ_JOINT, names[k].c_str())]] = q[static_cast<Eigen::Index>(k)];
  mj_kinematics(&model, &data);
  const int body = mj_name2id(&model, mjOBJ_BODY, "tool");
  const mjtNum *position = data.xpos + 3 * body, *rotation = data.xmat + 9 * body;
  return {Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rotation), Vec3(position)};
}

TEST(UrdfPatchLaw, MujocoFindsTheCalibratedToolPoses) {
  const std::string text = branched_arm();
  const auto in_file = parse_urdf(text, "arm.urdf", {.base_link = "", .tip_link = "tool"});
  ASSERT_TRUE(in_file.has_value()) << in_file.error().what;
  Chain corrected = *in_file;
  Rng rng(4);
  for (Joint& moved : corrected.joints) {
    if (!has_position(moved.type)) continue;
    auto& origin = std::get<UrdfLink>(moved.link).origin;
    origin.xyz += 2e-3 * normal_vector(rng);
    origin.small_rotation = 5e-3 * normal_vector(rng);
  }
  const auto origins = calibrated_origins(*in_file, corrected, EncoderOffsets::folded);
  ASSERT_TRUE(origins.has_value()) << origins.error().what;
  const auto patched = patch_urdf(text, "arm.urdf", *origins);
  ASSERT_TRUE(patched.has_value()) << patched.error().what;
  const auto model = laws::mujoco_model(patched->text);
  ASSERT_TRUE(model);
  const std::unique_ptr<mjData, laws::MujocoFree> data(mj_makeData(model.get()));
  for (std::uint64_t k = 0; k < 200; ++k) {
    const VectorXd q = laws::random_q(corrected, Rng(1).stream(k));
    const Pose expected = forward(corrected, q), found = tool_in_mujoco(*model, *data, corrected, q);
    EXPECT_LT((expected.position - found.position).norm(), 1e-9);
    EXPECT_LT((expected.rotation - found.rotation).cwiseAbs().maxCoeff(), 1e-9);
  }
}

}  // namespace
}  // namespace kinfer
