// SPDX-License-Identifier: Apache-2.0
// MuJoCo as judge of MJCF files that were read, and of those that were changed in place.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kinfer/geometry/random.hpp"
#include "kinfer/io/robot/mjcf/mjcf.hpp"
#include "kinfer/io/robot/patch/mjcf_patch.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"
#include "laws/mujoco_poses.hpp"
#include "support/mjcf_samples.hpp"

namespace kinfer {
namespace {

Chain read_chain(const std::string& text, const std::string& tip) {
  auto chain = parse_mjcf(text, "arm.xml", {.base_link = "", .tip_link = tip});
  EXPECT_TRUE(chain.has_value()) << chain.error().what << "\n" << text;
  return chain.value_or(Chain{});
}

/// 200 poses of MuJoCo at q + offset against the chain's at q.
void expect_mujoco_agrees(const std::string& text, const std::string& tip, const Chain& chain, const VectorXd& offset) {
  const auto model = laws::mujoco_model(text);
  ASSERT_TRUE(model);
  const std::unique_ptr<mjData, laws::MujocoFree> data(mj_makeData(model.get()));
  for (std::uint64_t k = 0; k < 200; ++k) {
    const VectorXd q = laws::random_q(chain, Rng(1).stream(k));
    laws::set_positions(*model, *data, active_joint_names(chain), q + offset);
    const Pose expected = laws::pose_of(*model, *data, tip), found = forward(chain, q);
    ASSERT_LT((expected.position - found.position).norm(), 1e-9) << tip << "\n" << text;
    ASSERT_LT((expected.rotation - found.rotation).cwiseAbs().maxCoeff(), 1e-9) << tip;
  }
}

void expect_mujoco_agrees(const std::string& text, const std::string& tip, const Chain& chain) {
  expect_mujoco_agrees(text, tip, chain, VectorXd::Zero(dof(chain)));
}

Chain with_errors(Chain chain, std::uint64_t seed) {
  Rng rng(seed);
  for (Joint& joint : chain.joints) {
    if (!has_position(joint.type)) continue;
    auto& origin = std::get<UrdfLink>(joint.link).origin;
    origin.xyz += 2e-3 * normal_vector(rng);
    origin.small_rotation = 5e-3 * normal_vector(rng);
  }
  return with_small_rotations_folded(chain);
}

VectorXd offsets_of(const Chain& chain, const std::vector<CalibratedOrigin>& origins) {
  const std::vector<std::string> names = active_joint_names(chain);
  VectorXd offset = VectorXd::Zero(dof(chain));
  for (std::size_t k = 0; k < names.size(); ++k)
    for (const CalibratedOrigin& origin : origins)
      if (origin.joint == names[k]) offset[static_cast<Eigen::Index>(k)] = origin.offset;
  return offset;
}

void expect_mujoco_finds_the_corrected_poses(const std::string& text, const std::string& tip, EncoderOffsets offsets,
                                             std::uint64_t seed) {
  const Chain in_file = read_chain(text, tip), corrected = with_errors(in_file, seed);
  const auto origins = calibrated_origins(in_file, corrected, offsets);
  ASSERT_TRUE(origins.has_value()) << origins.error().what;
  const auto patched = patch_mjcf(text, "arm.xml", {.base_link = "world", .tip_link = tip}, *origins);
  ASSERT_TRUE(patched.has_value()) << patched.error().what;
  expect_mujoco_agrees(patched->text, tip, corrected, offsets_of(corrected, *origins));
}

TEST(MjcfReadLaw, MujocoHasBodiesAndSitesWhereTheChainHasThem) {
  for (const char* tip : {"tcp", "hand", "twist", "upper", "shoulder", "side", "part"})
    expect_mujoco_agrees(test::awkward_mjcf(), tip, read_chain(test::awkward_mjcf(), tip));
}

TEST(MjcfReadLaw, WhatWasWrittenIsReadWithTheSamePoses) {
  for (Chain chain : laws::examples_with_joints()) {  // serial arms, trees, couplings, gains
    for (Joint& joint : chain.joints) joint.compliance = 0.0;
    const std::string text = format_mjcf(chain);
    const Chain read = read_chain(text, "tool");
    ASSERT_EQ(active_joint_names(read), active_joint_names(chain));
    expect_mujoco_agrees(text, "tool", read);
    expect_mujoco_agrees(text, "tool", chain);
  }
}

TEST(MjcfPatchLaw, MujocoFindsTheCalibratedPoses) {
  for (const EncoderOffsets offsets : {EncoderOffsets::folded, EncoderOffsets::separate}) {
    for (const char* tip : {"tcp", "side", "upper"})
      expect_mujoco_finds_the_corrected_poses(test::awkward_mjcf(), tip, offsets, 4);
    for (Chain chain : laws::examples_with_joints()) {
      for (Joint& joint : chain.joints) joint.compliance = 0.0;
      expect_mujoco_finds_the_corrected_poses(format_mjcf(chain), "tool", offsets, 5);
    }
  }
}

}  // namespace
}  // namespace kinfer
