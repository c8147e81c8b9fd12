#include "kinfer/identify/refined_joint.hpp"

#include <cmath>

#include "kinfer/inertial/joint_signals.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr double unknown_reach = 0.3;  // [m] sd of a point beyond which a direction counts as not known

/// The two directions across an axis that standard deviations are stated for.
std::array<Vec3, 2> across(const Vec3& axis) {
  const Vec3 x = any_perpendicular(axis).normalized();
  return {x, axis.cross(x)};
}

double root_of(double variance) {
  return std::sqrt(std::max(0.0, variance));
}

/// Sd of a vector's components across an axis. `first`: of the vector's three numbers.
std::array<double, 2> point_sd(ConstMatrixRef covariance, Index first, const Vec3& axis) {
  std::array<double, 2> sd{};
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 direction = across(axis)[i];
    sd[i] = root_of(direction.dot(covariance.block<3, 3>(first, first) * direction));
  }
  return sd;
}

/// Turns about the frame's x and y, `first` and the next unknown, move its z along −y and x.
std::array<double, 2> axis_sd(ConstMatrixRef covariance, Index first, const Mat3& frame) {
  std::array<double, 2> sd{};
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 direction = across(frame.col(2))[i];
    const Eigen::Vector2d by_turns(-direction.dot(frame.col(1)), direction.dot(frame.col(0)));
    sd[i] = root_of(by_turns.dot(covariance.block<2, 2>(first, first) * by_turns));
  }
  return sd;
}

/// Eigenvectors of a point's covariance that are too long to be knowledge.
std::vector<Vec3> long_directions(const Mat3& covariance) {
  const SymmetricEigen eigen = symmetric_eigen(covariance);
  std::vector<Vec3> directions;
  for (Index i = 0; i < 3; ++i)
    if (eigen.values[i] > unknown_reach * unknown_reach) directions.push_back(eigen.vectors.col(i));
  return directions;
}

/// Directions of a point that stay unknown even if everything else about the joint were known.
std::vector<Vec3> hidden_directions(ConstMatrixRef covariance, Index point) {
  const auto information = inverse_positive(covariance);
  if (!information) return long_directions(covariance.block<3, 3>(point, point));
  const auto alone = inverse_positive(information->block<3, 3>(point, point));
  return long_directions(alone ? Mat3(*alone) : Mat3(covariance.block<3, 3>(point, point)));
}

/// The joint's line and its pose at the reading `zero`; the sense as told in the header.
HingeGeometry geometry_of(const InsBody& body, double zero) {
  const Mat3 &a = body.parent_R_axis, &b = body.child_R_axis;
  HingeGeometry g;
  g.axis_in_parent = a.col(2);
  g.axis_in_child = b.col(2);
  const double along = g.axis_in_child.dot(body.point_in_child);
  g.point_in_child = body.point_in_child - along * g.axis_in_child;
  g.point_in_parent = body.point_in_parent - along * g.axis_in_parent;
  const bool turns = body.motion == JointMotion::turn;
  if (body.motion == JointMotion::slide) g.point_in_parent += zero * g.axis_in_parent;
  g.home.rotation = a * rot_z(turns ? zero : 0.0) * b.transpose();
  g.home.position = g.point_in_parent - g.home.rotation * g.point_in_child;
  Index largest = 0;
  g.axis_in_parent.cwiseAbs().maxCoeff(&largest);
  if (g.axis_in_parent[largest] < 0.0) {
    g.axis_in_parent = -g.axis_in_parent;
    g.axis_in_child = -g.axis_in_child;
  }
  return g;
}

void state_hinge(FoundJoint& joint, const InsBody& body, ConstMatrixRef covariance) {
  constexpr Index parent_turn = 0, child_turn = 2, in_parent = 4, in_child = 7;
  const Mat3 &a = body.parent_R_axis, &b = body.child_R_axis;
  joint.sd.axis_in_parent = axis_sd(covariance, parent_turn, a);
  joint.sd.axis_in_child = axis_sd(covariance, child_turn, b);
  joint.sd.point_in_parent = point_sd(covariance, in_parent, joint.axis_in_parent);
  joint.sd.point_in_child = point_sd(covariance, in_child, joint.axis_in_child);
  VectorXd slide(10);  // derivative of axis·p − axis·c
  const Vec3 &p = body.point_in_parent, &c = body.point_in_child;
  slide << -p.dot(a.col(1)), p.dot(a.col(0)), c.dot(b.col(1)), -c.dot(b.col(0)), a.col(2), -b.col(2);
  joint.sd.slide = root_of(slide.dot(covariance * slide));
  joint.not_identifiable_in_parent = hidden_directions(covariance, in_parent);
  joint.not_identifiable_in_child = hidden_directions(covariance, in_child);
}

/// A slide's line runs through the child's origin by convention, so nothing of its place there is estimated.
void state_slide(FoundJoint& joint, const InsBody& body, ConstMatrixRef covariance) {
  joint.sd.axis_in_parent = axis_sd(covariance, 0, body.parent_R_axis);
  joint.sd.axis_in_child = axis_sd(covariance, 2, body.child_R_axis);
  joint.sd.point_in_parent = point_sd(covariance, 5, joint.axis_in_parent);
  joint.sd.slide = root_of(joint.axis_in_parent.dot(covariance.block<3, 3>(5, 5) * joint.axis_in_parent));
  for (const Vec3& direction : long_directions(covariance.block<3, 3>(5, 5)))
    if (std::abs(direction.dot(joint.axis_in_parent)) < 0.7) joint.not_identifiable_in_parent.push_back(direction);
}

void state_rigid(FoundJoint& joint, const InsBody& body, ConstMatrixRef covariance) {
  joint.sd.axis_in_child = joint.sd.axis_in_parent = axis_sd(covariance, 0, body.child_R_axis);
  joint.sd.point_in_parent = point_sd(covariance, 3, joint.axis_in_parent);
  joint.sd.slide = root_of(joint.axis_in_parent.dot(covariance.block<3, 3>(3, 3) * joint.axis_in_parent));
  joint.not_identifiable_in_parent = long_directions(covariance.block<3, 3>(3, 3));
}

/// Axes of a universal joint, or the centre of it and of a spherical one.
void state_centre(FoundJoint& joint, std::span<const InsBody> bodies, ConstMatrixRef covariance) {
  const InsBody &near = bodies.front(), &far = bodies.back();
  joint.point_in_parent = near.point_in_parent;
  joint.point_in_child = far.point_in_child;
  const Index in_child = covariance.cols() - 3, in_parent = bodies.size() > 1 ? near.unknowns() - 3 : 0;
  if (joint.type == FoundJointType::universal) {
    joint.axis_in_parent = near.parent_R_axis.col(2);
    joint.axis_in_child = far.child_R_axis.col(2);
    joint.sd.axis_in_parent = axis_sd(covariance, 0, near.parent_R_axis);
    joint.sd.axis_in_child = axis_sd(covariance, near.unknowns() + 1, far.child_R_axis);
  }
  joint.sd.point_in_parent = point_sd(covariance, in_parent, joint.axis_in_parent);
  joint.sd.point_in_child = point_sd(covariance, in_child, joint.axis_in_child);
  joint.not_identifiable_in_parent = hidden_directions(covariance, in_parent);
  joint.not_identifiable_in_child = hidden_directions(covariance, in_child);
}

/// A universal or spherical joint at its readings' zero. Of a ball the axes say nothing.
HingeGeometry last_hinge(std::span<const InsBody> bodies, std::span<const double> zero) {
  const InsBody &near = bodies.front(), &far = bodies.back();
  HingeGeometry g;
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

/// Of one body, or of the bodies of a universal or spherical joint.
HingeGeometry geometry_of(FoundJointType type, std::span<const InsBody> bodies, std::span<const double> zero) {
  return type == FoundJointType::universal || type == FoundJointType::spherical
             ? last_hinge(bodies, zero)
             : geometry_of(bodies.front(), zero.front());
}

/// Standard deviations of the DH rows, by differences. `here`: the joint's geometry.
std::vector<DhNumbers> row_deviations(FoundJointType type, std::span<const InsBody> bodies,
                                      std::span<const double> zero, const HingeGeometry& here,
                                      ConstMatrixRef covariance) {
  constexpr double step = 1e-6;  // [rad], [m]
  constexpr std::array<double DhNumbers::*, 5> numbers{&DhNumbers::theta, &DhNumbers::d, &DhNumbers::alpha,
                                                       &DhNumbers::a, &DhNumbers::beta};
  const std::vector<DhNumbers> rows = joint_rows(type, here);
  MatrixXd derivative(static_cast<Index>(5 * rows.size()), covariance.cols());
  Index column = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (Index k = 0; k < bodies[b].unknowns(); ++k, ++column) {
      std::vector<InsBody> moved(bodies.begin(), bodies.end());
      moved[b] = changed(bodies[b], step * VectorXd::Unit(bodies[b].unknowns(), k));
      HingeGeometry geometry = geometry_of(type, moved, zero);
      geometry.ball_axes = here.ball_axes;
      const std::vector<DhNumbers> there = joint_rows(type, geometry);
      for (std::size_t i = 0; i < 5 * rows.size(); ++i)
        derivative(static_cast<Index>(i), column) =
            wrapped(there[i / 5].*numbers[i % 5] - rows[i / 5].*numbers[i % 5]) / step;
    }
  const VectorXd variance = (derivative * covariance * derivative.transpose()).diagonal();
  std::vector<DhNumbers> sd(rows.size());
  for (std::size_t i = 0; i < 5 * rows.size(); ++i)
    sd[i / 5].*numbers[i % 5] = root_of(variance[static_cast<Index>(i)]);
  return sd;
}

}  // namespace

RefinedJoint refined_joint(FoundJointType type, std::span<const InsBody> bodies, std::span<const double> zero,
                           ConstMatrixRef covariance, const Mat3& ball_axes) {
  RefinedJoint result;
  FoundJoint& joint = result.found;
  joint.type = type;
  HingeGeometry& g = result.hinge.geometry;
  g = geometry_of(type, bodies, zero);
  g.ball_axes = ball_axes;
  result.hinge.precision.canonical_sd = row_deviations(type, bodies, zero, g, covariance);
  if (type == FoundJointType::universal || type == FoundJointType::spherical) {
    state_centre(joint, bodies, covariance);
    result.hinge.precision.sd = joint.sd;
    return result;
  }
  const InsBody& body = bodies.front();
  joint.axis_in_parent = g.axis_in_parent;
  joint.axis_in_child = g.axis_in_child;
  joint.point_in_parent = g.point_in_parent;
  joint.point_in_child = g.point_in_child;
  if (body.motion == JointMotion::turn)
    state_hinge(joint, body, covariance);
  else if (body.motion == JointMotion::slide)
    state_slide(joint, body, covariance);
  else
    state_rigid(joint, body, covariance);
  result.hinge.precision.sd = joint.sd;
  return result;
}

}  // namespace kinfer
