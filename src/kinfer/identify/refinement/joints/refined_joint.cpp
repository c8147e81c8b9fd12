// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/joints/refined_joint.hpp"

#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/identify/refinement/fits/thresholds.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

/// The two directions perpendicular to an axis for which standard deviations are stated.
std::array<Vec3, 2> perpendicular_directions(const Vec3& axis) {
  const Vec3 x = any_perpendicular(axis).normalized();
  return {x, axis.cross(x)};
}

double sd_of(double variance) {
  return std::sqrt(std::max(0.0, variance));
}

/// Sd of a vector's components perpendicular to an axis. `first`: first unknown of the vector's three.
std::array<double, 2> point_sd(ConstMatrixRef covariance, Index first, const Vec3& axis) {
  std::array<double, 2> sd{};
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 direction = perpendicular_directions(axis)[i];
    sd[i] = sd_of(direction.dot(covariance.block<3, 3>(first, first) * direction));
  }
  return sd;
}

/// A point that is stated at another place of its axis, p − along · z: first unknowns of point and frame.
struct MovedPoint {
  Index point = 0, turn = 0;
  const Mat3& frame;
  double along = 0.0;  ///< [m]
};

/// Likewise: it moves with the axis, z by −y and x of the frame for rotations about x and y.
std::array<double, 2> moved_point_sd(ConstMatrixRef covariance, const MovedPoint& moved, const Vec3& axis) {
  std::array<double, 2> sd{};
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 direction = perpendicular_directions(axis)[i];
    VectorXd by = VectorXd::Zero(covariance.cols());
    by.segment<3>(moved.point) = direction;
    by[moved.turn] = moved.along * direction.dot(moved.frame.col(1));
    by[moved.turn + 1] = -moved.along * direction.dot(moved.frame.col(0));
    sd[i] = sd_of(by.dot(covariance * by));
  }
  return sd;
}

/// Sd of a frame's z axis: rotations about the frame's x and y, `first` and the next unknown, move z along −y and x.
std::array<double, 2> axis_sd(ConstMatrixRef covariance, Index first, const Mat3& frame) {
  std::array<double, 2> sd{};
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 direction = perpendicular_directions(frame.col(2))[i];
    const Eigen::Vector2d by_turns(-direction.dot(frame.col(1)), direction.dot(frame.col(0)));
    sd[i] = sd_of(by_turns.dot(covariance.block<2, 2>(first, first) * by_turns));
  }
  return sd;
}

/// Eigenvectors of a point's covariance with an sd above the limit.
std::vector<Vec3> uncertain_directions(const Mat3& covariance) {
  const SymmetricEigen eigen = symmetric_eigen(covariance);
  std::vector<Vec3> directions;
  for (Index i = 0; i < 3; ++i)
    if (eigen.values[i] > max_point_sd * max_point_sd) directions.push_back(eigen.vectors.col(i));
  return directions;
}

/// Directions of a point that are unobservable even if all other parameters of the joint were known.
std::vector<Vec3> unobservable_directions(ConstMatrixRef covariance, Index point) {
  const auto information = invert_spd(covariance);
  if (!information) return uncertain_directions(covariance.block<3, 3>(point, point));
  const auto alone = invert_spd(information->block<3, 3>(point, point));
  return uncertain_directions(alone ? Mat3(*alone) : Mat3(covariance.block<3, 3>(point, point)));
}

/// The joint's axis line and its pose at joint position `zero`. `sense`: of the axis, relative to the body's.
JointGeometry geometry_of(const InsBody& body, double zero, double sense) {
  const Mat3 &a = body.parent_R_axis, &b = body.child_R_axis;
  JointGeometry g;
  g.axis_in_parent = a.col(2);
  g.axis_in_child = b.col(2);
  const double along = g.axis_in_child.dot(body.point_in_child);
  g.point_in_child = body.point_in_child - along * g.axis_in_child;
  g.point_in_parent = body.point_in_parent - along * g.axis_in_parent;
  const bool turns = body.motion == JointMotion::revolute;
  if (body.motion == JointMotion::prismatic) g.point_in_parent += zero * g.axis_in_parent;
  g.home.rotation = a * rot_z(turns ? zero : 0.0) * b.transpose();
  g.home.position = g.point_in_parent - g.home.rotation * g.point_in_child;
  g.axis_in_parent *= sense;
  g.axis_in_child *= sense;
  return g;
}

void set_revolute(JointEstimate& joint, const InsBody& body, ConstMatrixRef covariance) {
  constexpr Index parent_turn = 0, child_turn = 2, in_parent = 4, in_child = 7;
  const Mat3 &a = body.parent_R_axis, &b = body.child_R_axis;
  joint.sd.axis_in_parent = axis_sd(covariance, parent_turn, a);
  joint.sd.axis_in_child = axis_sd(covariance, child_turn, b);
  const double along = b.col(2).dot(body.point_in_child);
  joint.sd.point_in_parent = moved_point_sd(covariance, {in_parent, parent_turn, a, along}, joint.axis_in_parent);
  joint.sd.point_in_child = moved_point_sd(covariance, {in_child, child_turn, b, along}, joint.axis_in_child);
  VectorXd slide(10);  // derivative of axis·p − axis·c
  const Vec3 &p = body.point_in_parent, &c = body.point_in_child;
  slide << -p.dot(a.col(1)), p.dot(a.col(0)), c.dot(b.col(1)), -c.dot(b.col(0)), a.col(2), -b.col(2);
  joint.sd.along_axis = sd_of(slide.dot(covariance * slide));
  joint.unobservable_in_parent = unobservable_directions(covariance, in_parent);
  joint.unobservable_in_child = unobservable_directions(covariance, in_child);
}

/// A prismatic joint's axis passes through the child's origin by convention, so no point in the child is estimated.
void set_prismatic(JointEstimate& joint, const InsBody& body, double zero, ConstMatrixRef covariance) {
  joint.sd.axis_in_parent = axis_sd(covariance, 0, body.parent_R_axis);
  joint.sd.axis_in_child = axis_sd(covariance, 2, body.child_R_axis);
  joint.sd.point_in_parent = moved_point_sd(covariance, {5, 0, body.parent_R_axis, -zero}, joint.axis_in_parent);
  joint.sd.along_axis = sd_of(joint.axis_in_parent.dot(covariance.block<3, 3>(5, 5) * joint.axis_in_parent));
  for (const Vec3& direction : uncertain_directions(covariance.block<3, 3>(5, 5)))
    if (std::abs(direction.dot(joint.axis_in_parent)) < 0.7) joint.unobservable_in_parent.push_back(direction);
}

void set_rigid(JointEstimate& joint, const InsBody& body, ConstMatrixRef covariance) {
  joint.sd.axis_in_child = joint.sd.axis_in_parent = axis_sd(covariance, 0, body.child_R_axis);
  joint.sd.point_in_parent = point_sd(covariance, 3, joint.axis_in_parent);
  joint.sd.along_axis = sd_of(joint.axis_in_parent.dot(covariance.block<3, 3>(3, 3) * joint.axis_in_parent));
  joint.unobservable_in_parent = uncertain_directions(covariance.block<3, 3>(3, 3));
}

/// Axes and centre of a universal joint, or the centre of a spherical one.
void set_centre(JointEstimate& joint, std::span<const InsBody> bodies, ConstMatrixRef covariance) {
  const InsBody &near = bodies.front(), &far = bodies.back();
  joint.point_in_parent = near.point_in_parent;
  joint.point_in_child = far.point_in_child;
  const Index in_child = covariance.cols() - 3, in_parent = bodies.size() > 1 ? near.unknowns() - 3 : 0;
  if (joint.type == EstimatedJointType::universal) {
    joint.axis_in_parent = near.parent_R_axis.col(2);
    joint.axis_in_child = far.child_R_axis.col(2);
    joint.sd.axis_in_parent = axis_sd(covariance, 0, near.parent_R_axis);
    joint.sd.axis_in_child = axis_sd(covariance, near.unknowns() + 1, far.child_R_axis);
  }
  joint.sd.point_in_parent = point_sd(covariance, in_parent, joint.axis_in_parent);
  joint.sd.point_in_child = point_sd(covariance, in_child, joint.axis_in_child);
  joint.unobservable_in_parent = unobservable_directions(covariance, in_parent);
  joint.unobservable_in_child = unobservable_directions(covariance, in_child);
}

/// A universal or spherical joint at joint positions `zero`. The axes of a spherical joint have no meaning.
JointGeometry centred_geometry(std::span<const InsBody> bodies, std::span<const double> zero) {
  const InsBody &near = bodies.front(), &far = bodies.back();
  JointGeometry g;
  g.home.rotation = bodies.size() > 1 ? Mat3(near.parent_R_axis * rot_z(zero[0]) * far.parent_R_axis * rot_z(zero[1]) *
                                             far.child_R_axis.transpose())
                                      : Mat3(exp_so3(Vec3(zero[0], zero[1], zero[2])) * far.child_R_axis.transpose());
  g.point_in_parent = near.point_in_parent;
  g.point_in_child = far.point_in_child;
  g.axis_in_child = far.child_R_axis.col(2);
  g.axis_in_parent = bodies.size() > 1 ? Vec3(near.parent_R_axis.col(2)) : Vec3(g.home.rotation * g.axis_in_child);
  g.home.position = g.point_in_parent - g.home.rotation * g.point_in_child;
  return g;
}

/// Geometry of one body, or of the bodies of a universal or spherical joint, whose axes keep their sense.
JointGeometry geometry_of(EstimatedJointType type, std::span<const InsBody> bodies, std::span<const double> zero,
                          double sense) {
  return type == EstimatedJointType::universal || type == EstimatedJointType::spherical
             ? centred_geometry(bodies, zero)
             : geometry_of(bodies.front(), zero.front(), sense);
}

/// Standard deviations of the DH rows, by finite differences. `here`: the joint's geometry.
std::vector<DhNumbers> dh_row_sd(EstimatedJointType type, std::span<const InsBody> bodies, std::span<const double> zero,
                                 double sense, const JointGeometry& here, ConstMatrixRef covariance) {
  constexpr double step = 1e-6;  // [rad], [m]
  constexpr std::array<double DhNumbers::*, 5> numbers{&DhNumbers::theta, &DhNumbers::d, &DhNumbers::alpha,
                                                       &DhNumbers::a, &DhNumbers::beta};
  const std::vector<DhNumbers> rows = joint_dh_rows(type, here);
  MatrixXd derivative(static_cast<Index>(5 * rows.size()), covariance.cols());
  Index column = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (Index k = 0; k < bodies[b].unknowns(); ++k, ++column) {
      std::vector<InsBody> moved(bodies.begin(), bodies.end());
      moved[b] = retract(bodies[b], step * VectorXd::Unit(bodies[b].unknowns(), k));
      JointGeometry geometry = geometry_of(type, moved, zero, sense);
      geometry.spherical_axes = here.spherical_axes;
      const std::vector<DhNumbers> there = joint_dh_rows(type, geometry);
      for (std::size_t i = 0; i < 5 * rows.size(); ++i)
        derivative(static_cast<Index>(i), column) =
            wrap_to_pi(there[i / 5].*numbers[i % 5] - rows[i / 5].*numbers[i % 5]) / step;
    }
  const VectorXd variance = propagated_covariance(derivative, covariance).diagonal();
  std::vector<DhNumbers> sd(rows.size());
  for (std::size_t i = 0; i < 5 * rows.size(); ++i) sd[i / 5].*numbers[i % 5] = sd_of(variance[static_cast<Index>(i)]);
  return sd;
}

}  // namespace

double axis_sense(const InsBody& body, const std::optional<PositiveAxis>& known) {
  const Vec3 axis = body.parent_R_axis.col(2);
  // In the child as well: a parent that does not move may say little of the axis.
  if (known) return axis.dot(known->in_parent) + body.child_R_axis.col(2).dot(known->in_child) < 0.0 ? -1.0 : 1.0;
  Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis[largest] < 0.0 ? -1.0 : 1.0;
}

RefinedJoint refined_joint(EstimatedJointType type, std::span<const InsBody> bodies, std::span<const double> zero,
                           ConstMatrixRef covariance, const Mat3& spherical_axes,
                           const std::optional<PositiveAxis>& known) {
  RefinedJoint result;
  result.zero.assign(zero.begin(), zero.end());
  JointEstimate& joint = result.estimate;
  joint.type = type;
  JointGeometry& g = result.solution.geometry;
  const double sense = axis_sense(bodies.front(), known);
  g = geometry_of(type, bodies, zero, sense);
  g.spherical_axes = spherical_axes;
  result.solution.precision.canonical_sd = dh_row_sd(type, bodies, zero, sense, g, covariance);
  if (type == EstimatedJointType::universal || type == EstimatedJointType::spherical) {
    set_centre(joint, bodies, covariance);
    result.solution.precision.sd = joint.sd;
    return result;
  }
  const InsBody& body = bodies.front();
  joint.axis_in_parent = g.axis_in_parent;
  joint.axis_in_child = g.axis_in_child;
  joint.point_in_parent = g.point_in_parent;
  joint.point_in_child = g.point_in_child;
  if (body.motion == JointMotion::revolute)
    set_revolute(joint, body, covariance);
  else if (body.motion == JointMotion::prismatic)
    set_prismatic(joint, body, zero.front(), covariance);
  else
    set_rigid(joint, body, covariance);
  result.solution.precision.sd = joint.sd;
  return result;
}

}  // namespace kinfer::identify
