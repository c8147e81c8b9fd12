// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/update/aligned_bodies.hpp"

#include <cmath>

#include "kinfer/geometry/rotation.hpp"
#include "kinfer/identify/handover/known_joint.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::identify {
namespace {

/// The rotation about its own z that brings a frame as near to another as it can.
Mat3 turn_about_axis(const Mat3& from, const Mat3& to) {
  const Mat3 turn = from.transpose() * to;
  return rot_z(std::atan2(turn(1, 0) - turn(0, 1), turn(0, 0) + turn(1, 1)));
}

/// Turns A and B alike about the joint's axis, so that A lies as near to `a` as it can.
void align_about_axis(TrackingBody& body, const Mat3& a) {
  const Mat3 about_axis = turn_about_axis(body.parent_R_axis, a);
  body.parent_R_axis = body.parent_R_axis * about_axis;
  body.child_R_axis = body.child_R_axis * about_axis;
}

/// Points along the axis: the one in the child is nearest to the child's sensor.
void drop_shift_along_axis(TrackingBody& body) {
  const Vec3 b = body.child_R_axis.col(2);
  const double along = b.dot(body.point_in_child);
  body.point_in_child -= along * b;
  body.point_in_parent -= along * body.parent_R_axis.col(2);
}

/// Joints that do not rotate have no point in the child.
void drop_point_in_child(TrackingBody& body) {
  body.point_in_parent -= body.parent_R_axis * body.child_R_axis.transpose() * body.point_in_child;
  body.point_in_child.setZero();
}

void align(TrackingBody& body, const TrackingBody& reference) {
  switch (body.motion) {
    case TrackingMotion::revolute:
      align_about_axis(body, reference.parent_R_axis);
      drop_shift_along_axis(body);
      break;
    case TrackingMotion::prismatic:
      align_about_axis(body, reference.parent_R_axis);
      drop_point_in_child(body);
      break;
    case TrackingMotion::fixed:
      drop_point_in_child(body);
      body.child_R_axis = body.child_R_axis * body.parent_R_axis.transpose() * reference.parent_R_axis;
      body.parent_R_axis = reference.parent_R_axis;
      break;
    case TrackingMotion::spherical:
      break;
  }
}

/// The frames between the two axes of a universal joint: M = Bᵀ₁ A₂ = Rz(α) Ry(β) Rz(γ), of which α and γ are zeros.
void align_universal(TrackingBody& near, TrackingBody& far, const TrackingBody& near_reference,
                     const TrackingBody& far_reference) {
  align_about_axis(near, near_reference.parent_R_axis);
  const Mat3 between = near.child_R_axis.transpose() * far.parent_R_axis;
  const double sense = far_reference.parent_R_axis(0, 2) < 0.0 ? -1.0 : 1.0;
  const double beta = sense * std::atan2(std::hypot(between(0, 2), between(1, 2)), between(2, 2));
  const Mat3 alpha = rot_z(std::atan2(sense * between(1, 2), sense * between(0, 2)));
  const Mat3 gamma = rot_y(-beta) * alpha.transpose() * between;
  near.child_R_axis = alpha.transpose();
  far.parent_R_axis = rot_y(beta);
  far.child_R_axis = far.child_R_axis * gamma.transpose();
}

/// The rotations of B are about its own axes, so that those of two logs agree only where B does: its zero, too.
void align_zeros(TrackingBodies& bodies, const TrackingBodies& reference) {
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (bodies[b].motion == TrackingMotion::revolute)
      bodies[b].child_R_axis =
          bodies[b].child_R_axis * turn_about_axis(bodies[b].child_R_axis, reference[b].child_R_axis);
}

Vec3 segment(const BodyDifference& step, TrackingParameterKind kind) {
  return step.segment<3>(3 * static_cast<Eigen::Index>(kind));
}

}  // namespace

TrackingBodies aligned(const TrackingModel& model, const TrackingModel& reference) {
  TrackingBodies bodies = model.bodies;
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const std::vector<std::size_t> own = bodies_of_joint(model, j);
    if (own.size() == 2)
      align_universal(bodies[own[0]], bodies[own[1]], reference.bodies[own[0]], reference.bodies[own[1]]);
    else
      align(bodies[own.front()], reference.bodies[own.front()]);
  }
  return bodies;
}

TrackingModel aligned_model(const TrackingModel& model, const TrackingModel& reference) {
  return transported(model, [&](const TrackingModel& one) {
    TrackingBodies bodies = aligned(one, reference);
    align_zeros(bodies, reference.bodies);
    return bodies;
  });
}

TrackingModel without_covariance(const TrackingModel& model) {
  TrackingModel result;
  result.sensors = model.sensors, result.bodies = model.bodies, result.joints = model.joints;
  result.tool = model.tool;
  return result;
}

TrackingModel transported(const TrackingModel& model, const BodiesChange& change) {
  constexpr double step = 1e-6;  // [rad], [m]
  TrackingModel bare = without_covariance(model);
  const auto after = [&](const TrackingParameter& p, double size) {
    TrackingBody& body = bare.bodies[static_cast<std::size_t>(p.index)];
    const TrackingBody before = body;
    body = retracted(body, size * BodyDifference::Unit(3 * static_cast<Eigen::Index>(p.kind) + p.component));
    TrackingBodies bodies = change(bare);
    body = before;
    return bodies;
  };
  const auto size = std::ssize(model.parameters);
  std::vector<TrackingParameter> geometry;
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < size; ++i)
    if (model.parameters[static_cast<std::size_t>(i)].kind <= TrackingParameterKind::point_in_child) {
      geometry.push_back(model.parameters[static_cast<std::size_t>(i)]);
      rows.push_back(i);
    }
  MatrixXd jacobian = MatrixXd::Identity(size, size);
  for (std::size_t k = 0; k < rows.size(); ++k)
    jacobian(rows, rows[k]) = difference(after(geometry[k], -step), after(geometry[k], step), geometry) / (2.0 * step);
  TrackingModel result = model;
  result.bodies = change(bare);
  result.covariance = propagated_covariance(jacobian, model.covariance);
  return result;
}

BodyDifference difference(const TrackingBody& from, const TrackingBody& to) {
  BodyDifference result;
  result << log_so3(from.parent_R_axis.transpose() * to.parent_R_axis),
      log_so3(from.child_R_axis.transpose() * to.child_R_axis), to.point_in_parent - from.point_in_parent,
      to.point_in_child - from.point_in_child;
  return result;
}

VectorXd difference(const TrackingBodies& from, const TrackingBodies& to,
                    const std::vector<TrackingParameter>& parameters) {
  VectorXd result(static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const TrackingParameter& p = parameters[i];
    const auto body = static_cast<std::size_t>(p.index);
    result[static_cast<Eigen::Index>(i)] =
        difference(from[body], to[body])[3 * static_cast<Eigen::Index>(p.kind) + p.component];
  }
  return result;
}

TrackingBody retracted(const TrackingBody& body, const BodyDifference& step) {
  using Kind = TrackingParameterKind;
  TrackingBody result = body;
  result.parent_R_axis = body.parent_R_axis * exp_so3(segment(step, Kind::parent_rotation));
  result.child_R_axis = body.child_R_axis * exp_so3(segment(step, Kind::child_rotation));
  result.point_in_parent += segment(step, Kind::point_in_parent);
  result.point_in_child += segment(step, Kind::point_in_child);
  return result;
}

VectorXd zero_offsets(const TrackingModel& model, const TrackingModel& reference) {
  const TrackingBodies own = aligned(model, reference);
  VectorXd offsets = VectorXd::Zero(model.positions());
  Eigen::Index next = 0;
  for (std::size_t b = 1; b < own.size(); ++b) {
    const TrackingBody &from = reference.bodies[b], &to = own[b];
    const BodyDifference change = difference(from, to);
    if (to.motion == TrackingMotion::revolute) offsets[next] = change[5];  // B turned about its axis by δ: q grows by δ
    if (to.motion == TrackingMotion::prismatic)
      offsets[next] = -from.parent_R_axis.col(2).dot(to.point_in_parent - from.point_in_parent);
    next += degrees_of_freedom(to.motion);
  }
  return offsets;
}

}  // namespace kinfer::identify
