// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/model/joint_transforms.hpp"

namespace kinfer {
namespace {

Pose rotation_z_translation_z(double angle, double shift) {
  return {rot_z(angle), Vec3(0, 0, shift)};
}

JointTransforms transforms(const DhLink& row) {
  return {rotation_z_translation_z(row.theta, row.d), {rot_x(row.alpha) * rot_y(row.beta), Vec3(row.a, 0, 0)}};
}

JointTransforms transforms(const MdhLink& row) {
  const Pose rotation_x_translation_x{rot_x(row.alpha), Vec3(row.a, 0, 0)}, rotation_y{rot_y(row.beta), Vec3::Zero()};
  return {rotation_x_translation_x * rotation_y * rotation_z_translation_z(row.theta, row.d), {}};
}

JointTransforms transforms(const UrdfLink& link) {
  return {link.origin.pose(), {}, link.axis};
}

}  // namespace

JointTransforms joint_transforms(const Link& link) {
  return std::visit([](const auto& l) { return transforms(l); }, link);
}

std::vector<MimicTerm> mimic_terms(const Chain& chain, int index) {
  const Joint& joint = chain.joints[index];
  std::vector<MimicTerm> all;
  if (joint.is_active && joint.gain != 1.0) all.push_back({joint.name, joint.gain - 1.0});
  for (const Coupling& coupling : joint.couplings) all.push_back({chain.joints[coupling.joint].name, coupling.factor});
  return all;
}

}  // namespace kinfer
