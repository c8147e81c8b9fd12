// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/handover/tracked_bodies.hpp"

#include <algorithm>
#include <numbers>

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;
using Kind = TrackingParameterKind;

/// Joint position `zero` becomes 0; `flip`: positions and axes change sign. `axes`: of a spherical joint.
struct PositionConvention {
  std::span<const double> zero;
  bool flip = false, has_axis_gauge = false;
  Mat3 axes = Mat3::Identity();
};

InsBody in_convention(InsBody body, const PositionConvention& convention) {
  const Mat3 sense = convention.flip ? rot_x(std::numbers::pi) : Mat3(Mat3::Identity());
  switch (body.motion) {
    case JointMotion::fixed:
      return body;
    case JointMotion::spherical: {  // exp(φ) Bᵀ with φ = 0 at `zero`, in the axes of the Cardan angles
      const Mat3 home = exp_so3(Vec3(convention.zero[0], convention.zero[1], convention.zero[2]));
      body.parent_R_axis = convention.axes;
      body.child_R_axis = body.child_R_axis * home.transpose() * convention.axes;
      return body;
    }
    case JointMotion::prismatic:
      body.point_in_parent += convention.zero[0] * body.parent_R_axis.col(2);
      body.child_R_axis = body.child_R_axis * sense;
      break;
    case JointMotion::revolute:
      body.child_R_axis = body.child_R_axis * rot_z(-convention.zero[0]) * sense;
      break;
  }
  body.parent_R_axis = body.parent_R_axis * sense;
  if (convention.has_axis_gauge) {
    const double along = body.child_R_axis.col(2).dot(body.point_in_child);
    body.point_in_child -= along * body.child_R_axis.col(2);
    body.point_in_parent -= along * body.parent_R_axis.col(2);
  }
  return body;
}

/// Components of a change of a body: rotations of A and B about their own axes, points.
using BodyChange = Eigen::Matrix<double, 12, 1>;
BodyChange change(const InsBody& from, const InsBody& to) {
  BodyChange result;
  result << log_so3(from.parent_R_axis.transpose() * to.parent_R_axis),
      log_so3(from.child_R_axis.transpose() * to.child_R_axis), to.point_in_parent - from.point_in_parent,
      to.point_in_child - from.point_in_child;
  return result;
}

/// Rows of a BodyChange that are parameters.
std::vector<Index> parameter_rows(const InsBody& body) {
  std::vector<Index> rows;
  for (std::size_t i = 0; i < 3; ++i)
    if (body.free_parent_rotation[i]) rows.push_back(static_cast<Index>(i));
  for (std::size_t i = 0; i < 3; ++i)
    if (body.free_child_rotation[i]) rows.push_back(static_cast<Index>(3 + i));
  for (Index i = 0; body.free_point_in_parent && i < 3; ++i) rows.push_back(6 + i);
  for (Index i = 0; body.free_point_in_child && i < 3; ++i) rows.push_back(9 + i);
  return rows;
}

MatrixXd convention_jacobian(const InsBody& body, const PositionConvention& convention,
                             const std::vector<Index>& rows) {
  constexpr double step = 1e-6;  // [rad], [m]
  const InsBody here = in_convention(body, convention);
  MatrixXd jacobian(static_cast<Index>(rows.size()), body.unknowns());
  for (Index k = 0; k < body.unknowns(); ++k) {
    const VectorXd unit = step * VectorXd::Unit(body.unknowns(), k);
    const BodyChange derivative = (change(here, in_convention(retract(body, unit), convention)) -
                                   change(here, in_convention(retract(body, -unit), convention))) /
                                  (2.0 * step);
    for (std::size_t i = 0; i < rows.size(); ++i) jacobian(static_cast<Index>(i), k) = derivative[rows[i]];
  }
  return jacobian;
}

TrackingMotion motion_of(JointMotion motion) {
  constexpr std::array<TrackingMotion, 4> motions{TrackingMotion::fixed, TrackingMotion::revolute,
                                                  TrackingMotion::prismatic, TrackingMotion::spherical};
  return motions[static_cast<std::size_t>(motion)];
}

TrackingBody tracking_body(const InsBody& body) {
  return {.motion = motion_of(body.motion),
          .parent_R_axis = body.parent_R_axis,
          .child_R_axis = body.child_R_axis,
          .point_in_parent = body.point_in_parent,
          .point_in_child = body.point_in_child};
}

void append_rows(TrackedBodies& tracked, const MatrixXd& jacobian) {
  MatrixXd all = MatrixXd::Zero(tracked.jacobian.rows() + jacobian.rows(), tracked.jacobian.cols() + jacobian.cols());
  all.topLeftCorner(tracked.jacobian.rows(), tracked.jacobian.cols()) = tracked.jacobian;
  all.bottomRightCorner(jacobian.rows(), jacobian.cols()) = jacobian;
  tracked.jacobian = std::move(all);
}

}  // namespace

TrackedBodies tracked_bodies(EstimatedJointType type, std::span<const InsBody> bodies, std::span<const double> zero,
                             const JointGeometry& geometry) {
  constexpr std::array<Kind, 4> kinds{Kind::parent_rotation, Kind::child_rotation, Kind::point_in_parent,
                                      Kind::point_in_child};
  TrackedBodies tracked;
  tracked.jacobian.resize(0, 0);
  PositionConvention convention{.zero = zero, .axes = geometry.spherical_axes};
  convention.flip = bodies.size() == 1 && bodies.front().motion != JointMotion::spherical &&
                    geometry.axis_in_parent.dot(bodies.front().parent_R_axis.col(2)) < 0.0;
  convention.has_axis_gauge = type == EstimatedJointType::revolute;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const std::vector<Index> rows = parameter_rows(bodies[b]);
    tracked.bodies.push_back(tracking_body(in_convention(bodies[b], convention)));
    for (const Index row : rows)
      tracked.parameters.push_back(
          {kinds[static_cast<std::size_t>(row / 3)], static_cast<int>(b), static_cast<int>(row % 3)});
    append_rows(tracked, convention_jacobian(bodies[b], convention, rows));
    convention.zero =
        convention.zero.subspan(static_cast<std::size_t>(std::max<Index>(1, degrees_of_freedom(bodies[b].motion))));
  }
  return tracked;
}

}  // namespace kinfer::identify
