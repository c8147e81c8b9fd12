// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/solver/fact_residuals.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/estimate/continuous/model/azimuth.hpp"
#include "kinfer/geometry/fit.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;
using Rows3 = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// Pose of a body and its joint at one time, in the root's frame.
struct BodyKinematics {
  Mat3 parent = Mat3::Identity();     // root_R_parent
  Mat3 before = Mat3::Identity();     // root_R_parent A: joint axes before the joint rotation
  Mat3 after = Mat3::Identity();      // the same after the joint rotation
  Mat3 rotation_axes = Mat3::Zero();  // root: rotation axis of each degree of freedom, a column each
  Mat3 rotation = Mat3::Identity();   // root_R_body
  Vec3 pivot = Vec3::Zero();          // the joint point p
  Vec3 joint = Vec3::Zero();          // p + prismatic displacement
  Vec3 origin = Vec3::Zero();         // of the body
};

/// Forward kinematics of the machine at one time.
struct Snapshot {
  Index interval = 0;
  SplineBasis basis;
  std::vector<BodyKinematics> body;
};

double spline_dimension_value(const MatrixXd& coefficients, Index spline_dimension, Index interval,
                              const SplineBasis& basis) {
  double sum = 0.0;
  for (Index i = 0; i < spline_order; ++i)
    sum += basis.at[0][static_cast<std::size_t>(i)] * coefficients(spline_dimension, interval + i);
  return sum;
}

Mat3 joint_rotation(JointMotion motion, const Vec3& position) {
  if (motion == JointMotion::revolute) return rot_z(position.x());
  if (motion == JointMotion::spherical) return exp_so3(position);
  return Mat3::Identity();
}

/// Rotation axes of the joint's degrees of freedom in the joint's frame, a column each.
Mat3 rotation_axes(JointMotion motion, const Vec3& position) {
  Mat3 axes = Mat3::Zero();
  if (motion == JointMotion::revolute) axes.col(0) = Vec3::UnitZ();
  if (motion == JointMotion::spherical) axes = right_jacobian(-position);  // the left Jacobian
  return axes;
}

Snapshot snapshot(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, double time) {
  const auto [interval, place] = problem.grid.locate(time);
  Snapshot s{interval, spline_basis(place, problem.grid.period), {BodyKinematics{}}};
  for (std::size_t b = 1; b < x.bodies.size(); ++b) {
    const InsBody& body = x.bodies[b];
    const BodyKinematics& parent = s.body[static_cast<std::size_t>(body.parent)];
    Vec3 vector = Vec3::Zero();
    for (Index i = 0; i < degrees_of_freedom(body.motion); ++i)
      vector[i] = spline_dimension_value(x.spline_coefficients, layout.spline_dimension[b] + i, interval, s.basis);
    const double q = vector.x();
    BodyKinematics placed{.parent = parent.rotation, .before = parent.rotation * body.parent_R_axis};
    placed.after = placed.before * joint_rotation(body.motion, vector);
    placed.rotation_axes = placed.before * rotation_axes(body.motion, vector);
    placed.rotation = placed.after * body.child_R_axis.transpose();
    placed.pivot = parent.origin + parent.rotation * body.point_in_parent;
    placed.joint = placed.pivot + (body.motion == JointMotion::prismatic ? q : 0.0) * placed.before.col(2);
    placed.origin = placed.joint - placed.rotation * body.point_in_child;
    s.body.push_back(placed);
  }
  return s;
}

/// A point, or a line with its direction, and the Jacobians of both with respect to all unknowns.
struct PointWithJacobian {
  Vec3 position = Vec3::Zero(), direction = Vec3::Zero();
  Rows3 by_position, by_direction;
};

class PointJacobian {
 public:
  PointJacobian(const InsLayout& layout, const InsUnknowns& x, const Snapshot& s) : layout_(layout), x_(x), s_(s) {}

  PointWithJacobian evaluate(const InsPoint& point) const {
    const BodyKinematics& body = s_.body[static_cast<std::size_t>(point.body)];
    const bool of_joint = point.kind == InsPoint::Kind::joint_centre || point.kind == InsPoint::Kind::joint_axis;
    PointWithJacobian p{of_joint ? body.pivot : body.origin, Vec3::Zero(), zero(), zero()};
    if (point.kind == InsPoint::Kind::joint_axis) p.direction = body.before.col(2);
    if (point.kind == InsPoint::Kind::place) {
      p.position += body.rotation * x_.facts.places[static_cast<std::size_t>(point.place)];
      p.by_position.middleCols<3>(local() + layout_.facts + 3 * point.place) += body.rotation;
    }
    int b = point.body;
    if (of_joint) {
      by_parent_side(p, static_cast<std::size_t>(b));
      b = x_.bodies[static_cast<std::size_t>(b)].parent;
    }
    for (; b > 0; b = x_.bodies[static_cast<std::size_t>(b)].parent) {
      by_child_side(p, static_cast<std::size_t>(b));
      by_parent_side(p, static_cast<std::size_t>(b));
    }
    return p;
  }

  Index local() const { return spline_order * layout_.spline_dimensions; }
  Rows3 zero() const { return Rows3::Zero(3, local() + layout_.global_parameters); }

 private:
  void turn(PointWithJacobian& p, Index column, double factor, const Vec3& axis, const Vec3& about) const {
    p.by_position.col(column) += factor * axis.cross(p.position - about);
    p.by_direction.col(column) += factor * axis.cross(p.direction);
  }

  /// Derivatives with respect to A and the point p.
  void by_parent_side(PointWithJacobian& p, std::size_t b) const {
    const InsBody& body = x_.bodies[b];
    const BodyKinematics& placed = s_.body[b];
    Index at = local() + layout_.body[b];
    for (int i = 0; i < 3; ++i)
      if (body.free_parent_rotation[static_cast<std::size_t>(i)])
        turn(p, at++, 1.0, placed.before.col(i), placed.pivot);
    at = local() + layout_.body[b] + std::ranges::count(body.free_parent_rotation, true) +
         std::ranges::count(body.free_child_rotation, true);
    if (body.free_point_in_parent) p.by_position.middleCols<3>(at) += placed.parent;
  }

  /// Derivatives with respect to B, the point c and the joint position.
  void by_child_side(PointWithJacobian& p, std::size_t b) const {
    const InsBody& body = x_.bodies[b];
    const BodyKinematics& placed = s_.body[b];
    Index at = local() + layout_.body[b] + std::ranges::count(body.free_parent_rotation, true);
    for (int i = 0; i < 3; ++i)
      if (body.free_child_rotation[static_cast<std::size_t>(i)]) turn(p, at++, -1.0, placed.after.col(i), placed.joint);
    at += body.free_point_in_parent ? 3 : 0;
    if (body.free_point_in_child) p.by_position.middleCols<3>(at) -= placed.rotation;
    if (layout_.spline_dimension[b] < 0) return;
    for (Index i = 0; i < spline_order; ++i)
      for (Index k = 0; k < degrees_of_freedom(body.motion); ++k) {
        const Index column = i * layout_.spline_dimensions + layout_.spline_dimension[b] + k;
        const double weight = s_.basis.at[0][static_cast<std::size_t>(i)];
        if (body.motion == JointMotion::prismatic)
          p.by_position.col(column) += weight * placed.before.col(2);
        else
          turn(p, column, weight, placed.rotation_axes.col(k), placed.joint);
      }
  }

  const InsLayout& layout_;
  const InsUnknowns& x_;
  const Snapshot& s_;
};

/// Positions along both lines of their closest points; 0 for a point.
std::pair<double, double> closest_points(const PointWithJacobian& a, const PointWithJacobian& b) {
  constexpr double parallel = 1e-3;  // sine of the angle below which lines count as parallel
  const Vec3 between = b.position - a.position;
  const double cosine = a.direction.dot(b.direction), square = 1.0 - cosine * cosine;
  const bool is_line = a.direction.norm() > 0.5, other_is_line = b.direction.norm() > 0.5;
  if (is_line && other_is_line && square > parallel * parallel) {
    const double along_a = a.direction.dot(between), along_b = b.direction.dot(between);
    return {(along_a - cosine * along_b) / square, (cosine * along_a - along_b) / square};
  }
  if (other_is_line) return {0.0, -b.direction.dot(between)};
  return {a.direction.dot(between), 0.0};
}

InsFactRows scaled(Index interval, const VectorXd& left, const MatrixXd& derivative, double sd) {
  return {interval, left / sd, derivative / sd};
}

InsFactRows tape_rows(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                      const InsTapeDistance& tape) {
  const Snapshot s = snapshot(problem, layout, x, tape.at);
  const PointJacobian mover(layout, x, s);
  const PointWithJacobian a = mover.evaluate(tape.from), b = mover.evaluate(tape.to);
  const auto [on_a, on_b] = closest_points(a, b);
  const Vec3 across = (b.position + on_b * b.direction) - (a.position + on_a * a.direction);
  const double distance = across.norm();
  const Vec3 n = distance > 1e-9 ? Vec3(across / distance) : Vec3(Vec3::UnitX());
  // The feet move along their lines, orthogonal to n: only the motion of the lines themselves contributes.
  const MatrixXd derivative =
      n.transpose() * (b.by_position + on_b * b.by_direction - a.by_position - on_a * a.by_direction);
  return scaled(s.interval, VectorXd::Constant(1, tape.length - distance), derivative, tape.sd);
}

Index first_touch(const InsProblem& problem, const InsLayout& layout) {
  return layout.facts + 3 * static_cast<Index>(problem.facts.places.size());
}

Index first_of_surveyor(const InsProblem& problem, const InsLayout& layout) {
  return first_touch(problem, layout) + 3 * static_cast<Index>(problem.facts.touches.size());
}

InsFactRows touch_rows(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, std::size_t touch,
                       double time) {
  const InsRevisitedPoint& fact = problem.facts.touches[touch];
  const Snapshot s = snapshot(problem, layout, x, time);
  const PointJacobian mover(layout, x, s);
  PointWithJacobian p = mover.evaluate(fact.point);
  p.by_position.middleCols<3>(mover.local() + first_touch(problem, layout) + 3 * static_cast<Index>(touch)) -=
      Mat3::Identity();
  return scaled(s.interval, x.facts.touched[touch] - p.position, p.by_position, fact.sd);
}

InsFactRows surveyed_rows(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                          const InsSurveyedPoint& fact) {
  const Snapshot s = snapshot(problem, layout, x, fact.at);
  const PointJacobian mover(layout, x, s);
  PointWithJacobian p = mover.evaluate(fact.point);
  const Index frame = mover.local() + first_of_surveyor(problem, layout);
  p.by_position.middleCols<3>(frame) -= Mat3::Identity();
  p.by_position.middleCols<3>(frame + 3) += x.facts.surveyor.rotation * skew(fact.xyz);
  return scaled(s.interval, x.facts.surveyor * fact.xyz - p.position, p.by_position, fact.sd);
}

/// The azimuths are constants of the machine, so any interval will do.
InsFactRows azimuth_rows(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x) {
  const InsAzimuthMeasurement& fact = problem.facts.azimuth;
  const auto count = static_cast<Index>(fact.azimuths.size());
  const Index local = spline_order * layout.spline_dimensions;
  VectorXd left(count);
  MatrixXd derivative = MatrixXd::Zero(count, local + layout.global_parameters);
  for (Index i = 0; i < count; ++i) {
    const InsAzimuth& azimuth = fact.azimuths[static_cast<std::size_t>(i)];
    left[i] = -azimuth_from(fact.directions[static_cast<std::size_t>(i)], x.bodies, azimuth);
    derivative.row(i).tail(layout.global_parameters) = azimuth_gradient(layout, x.bodies, azimuth).transpose();
  }
  return {0, fact.whitening * left, fact.whitening * derivative};
}

}  // namespace

std::vector<InsFactRows> fact_rows(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x) {
  std::vector<InsFactRows> rows;
  for (std::size_t t = 0; t < problem.facts.touches.size(); ++t)
    for (const double time : problem.facts.touches[t].at) rows.push_back(touch_rows(problem, layout, x, t, time));
  for (const InsTapeDistance& tape : problem.facts.tapes) rows.push_back(tape_rows(problem, layout, x, tape));
  for (const InsSurveyedPoint& fact : problem.facts.surveyed) rows.push_back(surveyed_rows(problem, layout, x, fact));
  if (!problem.facts.azimuth.azimuths.empty()) rows.push_back(azimuth_rows(problem, layout, x));
  return rows;
}

double fact_cost(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x) {
  double sum = 0.0;
  for (const InsFactRows& rows : fact_rows(problem, layout, x)) sum += rows.left.squaredNorm();
  return sum;
}

Vec3 point_position(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, const InsPoint& point,
                    double time) {
  const Snapshot s = snapshot(problem, layout, x, time);
  return PointJacobian(layout, x, s).evaluate(point).position;
}

InsFactUnknowns initial_fact_unknowns(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x) {
  InsUnknowns with_places = x;
  InsFactUnknowns& start = with_places.facts;
  start = {};
  for (const InsUnknownPoint& place : problem.facts.places) start.places.push_back(place.start);
  for (const InsRevisitedPoint& touch : problem.facts.touches) {
    Vec3 sum = Vec3::Zero();
    for (const double time : touch.at) sum += point_position(problem, layout, with_places, touch.point, time);
    start.touched.push_back(sum / static_cast<double>(touch.at.size()));
  }
  std::vector<Vec3> machine, surveyor;
  for (const InsSurveyedPoint& fact : problem.facts.surveyed) {
    machine.push_back(point_position(problem, layout, with_places, fact.point, fact.at));
    surveyor.push_back(fact.xyz);
  }
  if (machine.size() >= 3) start.surveyor = align_points(machine, surveyor);
  return start;
}

}  // namespace kinfer
