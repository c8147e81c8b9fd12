// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/joints/pair_joint.hpp"

#include "kinfer/geometry/fit.hpp"
#include "kinfer/identify/geometry/identified_chain.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

constexpr JointStandardDeviation not_estimated{{1.0, 1.0}, {1.0, 1.0}, {1.0, 1.0}, {1.0, 1.0}, 1.0};  // [rad], [m]

JointResult pair_result(const RecordedMotion& motion, std::size_t child, JointEstimate joint,
                        const JointGeometry& geometry, std::optional<IdentificationNoteKind> note) {
  JointResult result;
  result.dh = canonical_dh_rows(joint, {geometry, {}});
  if (note) result.notes = {{*note, {{"parent", joint.parent}, {"child", joint.child}}}};
  result.states = measured_states(motion.segments[child]);
  result.joint = std::move(joint);
  return result;
}

/// None of a revolute joint, which most joints are.
std::optional<IdentificationNoteKind> note_on(EstimatedJointType type) {
  if (type == EstimatedJointType::universal) return IdentificationNoteKind::universal_joint;
  if (type == EstimatedJointType::spherical) return IdentificationNoteKind::spherical_joint;
  return std::nullopt;
}

Mat3 initial_relative_rotation(const RecordedMotion& motion, std::size_t parent, std::size_t child) {
  const std::size_t row = motion.first_motion_row;
  return motion.segments[parent].rotation[row].transpose() * motion.segments[child].rotation[row];
}

/// Minimum-norm lever arm from the parent's sensor to the child's that explains their accelerations.
Vec3 fit_rigid_lever(const RecordedMotion& motion, const SegmentMotion& a, const SegmentMotion& b) {
  constexpr double prior_weight = 1e-4;  // [1/s⁴] per row: prior on the unobservable directions
  Mat3 normal = Mat3::Zero();
  Vec3 right = Vec3::Zero();
  for (std::size_t row = motion.first_motion_row; row < motion.rows(); ++row) {
    if (!motion.usable[row]) continue;
    const Mat3 angular_velocity = skew(a.angular_velocity[row]);
    const Mat3 effect = (skew(a.angular_acceleration[row]) + angular_velocity * angular_velocity) * a.rotation[row];
    normal += effect.transpose() * effect + prior_weight * Mat3::Identity();
    right += effect.transpose() * (b.acceleration[row] - a.acceleration[row]);
  }
  return solve_least_squares(normal, right);
}

JointEstimate estimate_between(const RecordedMotion& motion, std::size_t parent, std::size_t child,
                               EstimatedJointType type) {
  return {.parent = motion.segments[parent].name, .child = motion.segments[child].name, .type = type};
}

}  // namespace

JointResult prismatic_joint(const RecordedMotion& motion, std::size_t parent, std::size_t child,
                            const JointTypeEvidence& evidence) {
  JointGeometry geometry;
  geometry.axis_in_parent = evidence.axis_in_parent;
  geometry.axis_in_child = evidence.axis_in_child;
  geometry.home.rotation = initial_relative_rotation(motion, parent, child);
  JointEstimate joint = estimate_between(motion, parent, child, EstimatedJointType::prismatic);
  joint.axis_in_parent = geometry.axis_in_parent;
  joint.axis_in_child = geometry.axis_in_child;
  joint.sd = not_estimated;
  return pair_result(motion, child, std::move(joint), geometry, IdentificationNoteKind::prismatic_joint);
}

JointResult joint_about_point(const RecordedMotion& motion, const SegmentTree& tree, std::size_t parent,
                              std::size_t child, const JointTypeEvidence& evidence) {
  const PairFit& pair = tree.pair(parent, child);
  JointGeometry geometry;
  geometry.axis_in_parent = evidence.axis_in_parent;
  geometry.axis_in_child = evidence.axis_in_child;
  geometry.point_in_parent = pair.first == parent ? pair.point_in_first : pair.point_in_second;
  geometry.point_in_child = pair.first == parent ? pair.point_in_second : pair.point_in_first;
  geometry.home.rotation = initial_relative_rotation(motion, parent, child);
  geometry.home.position = geometry.point_in_parent - geometry.home.rotation * geometry.point_in_child;
  JointEstimate joint = estimate_between(motion, parent, child, evidence.type);
  joint.axis_in_parent = geometry.axis_in_parent;
  joint.axis_in_child = geometry.axis_in_child;
  joint.point_in_parent = geometry.point_in_parent;
  joint.point_in_child = geometry.point_in_child;
  joint.sd = not_estimated;
  return pair_result(motion, child, std::move(joint), geometry, note_on(evidence.type));
}

JointResult rigid_joint(const RecordedMotion& motion, std::size_t parent, std::size_t child) {
  const SegmentMotion &a = motion.segments[parent], &b = motion.segments[child];
  std::vector<Mat3> relative;
  for (std::size_t row = 0; row < motion.rows(); ++row)
    relative.push_back(a.rotation[row].transpose() * b.rotation[row]);
  JointGeometry mount;
  mount.home = {mean_rotation(relative), fit_rigid_lever(motion, a, b)};
  mount.axis_in_child = Vec3::UnitZ();
  mount.axis_in_parent = mount.home.rotation.col(2);
  mount.point_in_parent = mount.home.position;
  JointEstimate joint = estimate_between(motion, parent, child, EstimatedJointType::rigid);
  joint.axis_in_parent = mount.axis_in_parent;
  joint.point_in_parent = mount.point_in_parent;
  return pair_result(motion, child, std::move(joint), mount, IdentificationNoteKind::no_relative_motion);
}

}  // namespace kinfer::identify
