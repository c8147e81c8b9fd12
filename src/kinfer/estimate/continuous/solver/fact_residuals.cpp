// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/solver/fact_residuals.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/estimate/continuous/model/azimuth.hpp"
#include "kinfer/estimate/continuous/solver/body_kinematics.hpp"
#include "kinfer/estimate/continuous/solver/closure_residuals.hpp"
#include "kinfer/geometry/fit.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

/// A fact's point, or a line with its direction, with derivatives.
struct FactPoint {
  PointJacobian at;
  Vec3 direction = Vec3::Zero();

  Rows3 by_direction() const { return -skew(direction) * at.by_rotation; }
};

FactPoint evaluate(const InsLayout& layout, const InsUnknowns& x, const MachineSnapshot& s, const InsPoint& point) {
  const auto b = static_cast<std::size_t>(point.body);
  const bool of_joint = point.kind == InsPoint::Kind::joint_centre || point.kind == InsPoint::Kind::joint_axis;
  FactPoint p{of_joint ? jacobian_at_joint(layout, x, s, b)
                       : jacobian_at(layout, x, s, b,
                                     point.kind == InsPoint::Kind::place
                                         ? x.facts.places[static_cast<std::size_t>(point.place)]
                                         : Vec3(Vec3::Zero()))};
  if (point.kind == InsPoint::Kind::joint_axis) p.direction = s.body[b].before.col(2);
  if (point.kind == InsPoint::Kind::place)
    p.at.by_position.middleCols<3>(first_global(layout) + layout.facts + 3 * point.place) += s.body[b].rotation;
  return p;
}

/// Positions along both lines of their closest points; 0 for a point.
std::pair<double, double> closest_points(const FactPoint& a, const FactPoint& b) {
  constexpr double parallel = 1e-3;  // sine of the angle below which lines count as parallel
  const Vec3 between = b.at.position - a.at.position;
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
  const MachineSnapshot s = machine_snapshot(problem, layout, x, tape.at);
  const FactPoint a = evaluate(layout, x, s, tape.from), b = evaluate(layout, x, s, tape.to);
  const auto [on_a, on_b] = closest_points(a, b);
  const Vec3 across = (b.at.position + on_b * b.direction) - (a.at.position + on_a * a.direction);
  const double distance = across.norm();
  const Vec3 n = distance > 1e-9 ? Vec3(across / distance) : Vec3(Vec3::UnitX());
  // The feet move along their lines, orthogonal to n: only the motion of the lines themselves contributes.
  const MatrixXd derivative =
      n.transpose() * (b.at.by_position + on_b * b.by_direction() - a.at.by_position - on_a * a.by_direction());
  return scaled(s.interval, VectorXd::Constant(1, tape.length - distance), derivative, tape.sd);
}

Index first_touch(const InsProblem& problem, const InsLayout& layout) {
  return layout.facts + 3 * static_cast<Index>(problem.facts.places.size());
}

Index first_of_surveyor(const InsProblem& problem, const InsLayout& layout) {
  return layout.closures + closure_unknowns * static_cast<Index>(problem.facts.closures.size());
}

InsFactRows touch_rows(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, std::size_t touch,
                       double time) {
  const InsRevisitedPoint& fact = problem.facts.touches[touch];
  const MachineSnapshot s = machine_snapshot(problem, layout, x, time);
  PointJacobian p = evaluate(layout, x, s, fact.point).at;
  p.by_position.middleCols<3>(first_global(layout) + first_touch(problem, layout) + 3 * static_cast<Index>(touch)) -=
      Mat3::Identity();
  return scaled(s.interval, x.facts.touched[touch] - p.position, p.by_position, fact.sd);
}

InsFactRows surveyed_rows(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                          const InsSurveyedPoint& fact) {
  const MachineSnapshot s = machine_snapshot(problem, layout, x, fact.at);
  PointJacobian p = evaluate(layout, x, s, fact.point).at;
  const Index frame = first_global(layout) + first_of_surveyor(problem, layout);
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

/// Of touches, tapes, surveyed points and azimuths.
std::vector<InsFactRows> measured_rows(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x) {
  std::vector<InsFactRows> rows;
  for (std::size_t t = 0; t < problem.facts.touches.size(); ++t)
    for (const double time : problem.facts.touches[t].at) rows.push_back(touch_rows(problem, layout, x, t, time));
  for (const InsTapeDistance& tape : problem.facts.tapes) rows.push_back(tape_rows(problem, layout, x, tape));
  for (const InsSurveyedPoint& fact : problem.facts.surveyed) rows.push_back(surveyed_rows(problem, layout, x, fact));
  if (!problem.facts.azimuth.azimuths.empty()) rows.push_back(azimuth_rows(problem, layout, x));
  return rows;
}

}  // namespace

std::vector<InsFactRows> fact_rows(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x) {
  std::vector<InsFactRows> rows = measured_rows(problem, layout, x);
  for (std::size_t c = 0; c < problem.facts.closures.size(); ++c) append_closure_rows(problem, layout, x, c, rows);
  return rows;
}

double fact_cost(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x) {
  double sum = 0.0;
  for (std::size_t c = 0; c < problem.facts.closures.size(); ++c) sum += closure_cost(problem, layout, x, c);
  const InsFacts& facts = problem.facts;
  if (facts.touches.empty() && facts.tapes.empty() && facts.surveyed.empty() && facts.azimuth.azimuths.empty())
    return sum;
  for (const InsFactRows& rows : measured_rows(problem, layout, x)) sum += rows.left.squaredNorm();
  return sum;
}

Vec3 point_position(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, const InsPoint& point,
                    double time) {
  const MachineSnapshot s = machine_snapshot(problem, layout, x, time);
  return evaluate(layout, x, s, point).at.position;
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
  for (const InsClosure& closure : problem.facts.closures) start.closures.push_back(closure.start);
  std::vector<Vec3> machine, surveyor;
  for (const InsSurveyedPoint& fact : problem.facts.surveyed) {
    machine.push_back(point_position(problem, layout, with_places, fact.point, fact.at));
    surveyor.push_back(fact.xyz);
  }
  if (machine.size() >= 3) start.surveyor = align_points(machine, surveyor);
  return start;
}

}  // namespace kinfer
