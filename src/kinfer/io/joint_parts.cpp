#include "kinfer/io/joint_parts.hpp"

namespace kinfer {
namespace {

Pose turn_z_shift_z(double angle, double shift) {
  return {rot_z(angle), Vec3(0, 0, shift)};
}

JointParts parts(const DhLink& row) {
  return {turn_z_shift_z(row.theta, row.d), {rot_x(row.alpha) * rot_y(row.beta), Vec3(row.a, 0, 0)}};
}

JointParts parts(const MdhLink& row) {
  const Pose turn_x_shift_x{rot_x(row.alpha), Vec3(row.a, 0, 0)}, turn_y{rot_y(row.beta), Vec3::Zero()};
  return {turn_x_shift_x * turn_y * turn_z_shift_z(row.theta, row.d), {}};
}

JointParts parts(const UrdfLink& link) {
  return {link.origin.pose(), {}, link.axis};
}

}  // namespace

JointParts parts_of(const Link& link) {
  return std::visit([](const auto& l) { return parts(l); }, link);
}

std::vector<Follower> followers(const Chain& chain, int index) {
  const Joint& joint = chain.joints[index];
  std::vector<Follower> all;
  if (joint.has_reading && joint.gain != 1.0) all.push_back({joint.name, joint.gain - 1.0});
  for (const Coupling& coupling : joint.couplings) all.push_back({chain.joints[coupling.joint].name, coupling.factor});
  return all;
}

}  // namespace kinfer
