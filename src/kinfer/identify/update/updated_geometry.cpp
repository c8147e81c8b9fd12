// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/update/updated_geometry.hpp"

#include <algorithm>

#include "kinfer/geometry/cardan_angles.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/identify/refinement/fits/thresholds.hpp"
#include "kinfer/identify/update/combined_model.hpp"
#include "kinfer/identify/update/known_machine.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

/// Angles of a spherical joint in the axes of another model of it.
MatrixXd spherical_positions(const MatrixXd& positions, const TrackingBody& from, const TrackingBody& to) {
  MatrixXd result(3, positions.cols());
  Vec3 before = Vec3::Zero();
  for (Index i = 0; i < positions.cols(); ++i) {
    const Mat3 turn = rot_x(positions(0, i)) * rot_y(positions(1, i)) * rot_z(positions(2, i));
    const Mat3 parent_R_child = from.parent_R_axis * turn * from.child_R_axis.transpose();
    before = cardan_angles(to.parent_R_axis.transpose() * parent_R_child * to.child_R_axis, before);
    result.col(i) = before;
  }
  return result;
}

/// A joint's positions, counted from the zeros of `to` instead of `from`.
MatrixXd trajectory_of(const MatrixXd& positions, std::size_t joint, const TrackingModel& from,
                       const TrackingModel& to) {
  if (positions.size() == 0) return positions;
  const std::size_t body = bodies_of_joint(to, joint).front();
  if (to.bodies[body].motion == TrackingMotion::spherical)
    return spherical_positions(positions, from.bodies[body], to.bodies[body]);
  const TrackingJoint& own = to.joints[joint];
  const VectorXd offsets = zero_offsets(from, to).segment(own.first_position, own.positions);
  return positions.colwise() - offsets;
}

/// Whether an azimuth that the newer log alone does not tell is still unknown.
bool is_azimuth_unknown(const JointEstimate& fresh, const JointEstimate& updated) {
  return fresh.azimuth_unobservable && std::ranges::max(updated.sd.axis_in_child) > max_azimuth_sd;
}

std::vector<PointEstimate> tool_of(const TrackingModel& known, const TrackingModel& model) {
  if (model.tool.body_T_tool.position.isZero(1e-12)) return {};
  const int sensor = known.bodies[static_cast<std::size_t>(model.tool.body)].sensor;
  if (sensor < 0) return {};
  return {{.name = "tool",
           .sensor = known.sensors[static_cast<std::size_t>(sensor)].name,
           .xyz = model.tool.body_T_tool.position,
           .sd = model.tool.sd}};
}

}  // namespace

UpdatedGeometry update_geometry(const TrackingModel& known, ChainGeometry fresh) {
  const ChainComparison comparison = compare_chains(known, *fresh.tracking);
  TrackingModel model = combined(comparison, *fresh.tracking);
  UpdatedGeometry result{.geometry = std::move(fresh), .update = comparison.update};
  ChainGeometry& geometry = result.geometry;
  geometry.dh.clear();
  const std::vector<KnownJoint> joints = known_joints(model);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const RefinedJoint refined = as_refined(joints[j], model);
    JointEstimate& before = geometry.joints[j];
    JointEstimate joint = refined.estimate;
    joint.trajectory = trajectory_of(before.trajectory, j, *geometry.tracking, model);
    joint.azimuth_unobservable = is_azimuth_unknown(before, joint);
    before = std::move(joint);
    std::ranges::copy(canonical_dh_rows(before, refined.solution), std::back_inserter(geometry.dh));
  }
  if (geometry.places.empty()) geometry.places = tool_of(known, model);
  geometry.tracking = std::move(model);
  return result;
}

}  // namespace kinfer::identify
