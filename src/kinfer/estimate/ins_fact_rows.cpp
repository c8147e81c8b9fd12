#include "kinfer/estimate/ins_fact_rows.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/geometry/fit.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;
using Rows3 = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// A body and the joint that it hangs on at one time, in the root's frame.
struct PlacedBody {
  Mat3 parent = Mat3::Identity();    // root_R_parent
  Mat3 before = Mat3::Identity();    // root_R_parent A: axes of the joint before it turns
  Mat3 after = Mat3::Identity();     // the same after it has turned
  Mat3 turned_about = Mat3::Zero();  // root: what a change of each freedom of the reading turns about
  Mat3 rotation = Mat3::Identity();  // root_R_body
  Vec3 pivot = Vec3::Zero();         // the joint's point p
  Vec3 joint = Vec3::Zero();         // p + slide
  Vec3 origin = Vec3::Zero();        // of the body
};

/// The machine at one time.
struct Snapshot {
  Index interval = 0;
  SplineBasis basis;
  std::vector<PlacedBody> body;
};

double reading(const MatrixXd& band, Index channel, Index interval, const SplineBasis& basis) {
  double sum = 0.0;
  for (Index i = 0; i < spline_order; ++i)
    sum += basis.at[0][static_cast<std::size_t>(i)] * band(channel, interval + i);
  return sum;
}

Mat3 joint_turn(JointMotion motion, const Vec3& reading) {
  if (motion == JointMotion::turn) return rot_z(reading.x());
  if (motion == JointMotion::ball) return exp_so3(reading);
  return Mat3::Identity();
}

/// Axes of the joint that its freedoms turn about, a column each.
Mat3 turned_about(JointMotion motion, const Vec3& reading) {
  Mat3 axes = Mat3::Zero();
  if (motion == JointMotion::turn) axes.col(0) = Vec3::UnitZ();
  if (motion == JointMotion::ball) axes = right_jacobian(-reading);  // the left Jacobian
  return axes;
}

Snapshot snapshot(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, double time) {
  const auto [interval, place] = problem.grid.place(time);
  Snapshot s{interval, spline_basis(place, problem.grid.period), {PlacedBody{}}};
  for (std::size_t b = 1; b < x.bodies.size(); ++b) {
    const InsBody& body = x.bodies[b];
    const PlacedBody& parent = s.body[static_cast<std::size_t>(body.parent)];
    Vec3 vector = Vec3::Zero();
    for (Index i = 0; i < freedoms(body.motion); ++i)
      vector[i] = reading(x.band, layout.channel[b] + i, interval, s.basis);
    const double q = vector.x();
    PlacedBody placed{.parent = parent.rotation, .before = parent.rotation * body.parent_R_axis};
    placed.after = placed.before * joint_turn(body.motion, vector);
    placed.turned_about = placed.before * turned_about(body.motion, vector);
    placed.rotation = placed.after * body.child_R_axis.transpose();
    placed.pivot = parent.origin + parent.rotation * body.point_in_parent;
    placed.joint = placed.pivot + (body.motion == JointMotion::slide ? q : 0.0) * placed.before.col(2);
    placed.origin = placed.joint - placed.rotation * body.point_in_child;
    s.body.push_back(placed);
  }
  return s;
}

/// A point, its line's direction where it is one, and how both move with every unknown.
struct PlacedPoint {
  Vec3 position = Vec3::Zero(), direction = Vec3::Zero();
  Rows3 by_position, by_direction;
};

class PointMover {
 public:
  PointMover(const InsLayout& layout, const InsUnknowns& x, const Snapshot& s) : layout_(layout), x_(x), s_(s) {}

  PlacedPoint place(const InsPoint& point) const {
    const PlacedBody& body = s_.body[static_cast<std::size_t>(point.body)];
    const bool of_joint = point.kind == InsPoint::Kind::joint_centre || point.kind == InsPoint::Kind::joint_axis;
    PlacedPoint p{of_joint ? body.pivot : body.origin, Vec3::Zero(), zero(), zero()};
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

  Index local() const { return spline_order * layout_.channels; }
  Rows3 zero() const { return Rows3::Zero(3, local() + layout_.border); }

 private:
  void turn(PlacedPoint& p, Index column, double factor, const Vec3& axis, const Vec3& about) const {
    p.by_position.col(column) += factor * axis.cross(p.position - about);
    p.by_direction.col(column) += factor * axis.cross(p.direction);
  }

  /// Turns of A and the point p.
  void by_parent_side(PlacedPoint& p, std::size_t b) const {
    const InsBody& body = x_.bodies[b];
    const PlacedBody& placed = s_.body[b];
    Index at = local() + layout_.body[b];
    for (int i = 0; i < 3; ++i)
      if (body.free_parent_turn[static_cast<std::size_t>(i)]) turn(p, at++, 1.0, placed.before.col(i), placed.pivot);
    at = local() + layout_.body[b] + std::ranges::count(body.free_parent_turn, true) +
         std::ranges::count(body.free_child_turn, true);
    if (body.free_point_in_parent) p.by_position.middleCols<3>(at) += placed.parent;
  }

  /// Turns of B, the point c, and the reading.
  void by_child_side(PlacedPoint& p, std::size_t b) const {
    const InsBody& body = x_.bodies[b];
    const PlacedBody& placed = s_.body[b];
    Index at = local() + layout_.body[b] + std::ranges::count(body.free_parent_turn, true);
    for (int i = 0; i < 3; ++i)
      if (body.free_child_turn[static_cast<std::size_t>(i)]) turn(p, at++, -1.0, placed.after.col(i), placed.joint);
    at += body.free_point_in_parent ? 3 : 0;
    if (body.free_point_in_child) p.by_position.middleCols<3>(at) -= placed.rotation;
    if (layout_.channel[b] < 0) return;
    for (Index i = 0; i < spline_order; ++i)
      for (Index k = 0; k < freedoms(body.motion); ++k) {
        const Index column = i * layout_.channels + layout_.channel[b] + k;
        const double weight = s_.basis.at[0][static_cast<std::size_t>(i)];
        if (body.motion == JointMotion::slide)
          p.by_position.col(column) += weight * placed.before.col(2);
        else
          turn(p, column, weight, placed.turned_about.col(k), placed.joint);
      }
  }

  const InsLayout& layout_;
  const InsUnknowns& x_;
  const Snapshot& s_;
};

/// How far along their lines the points lie that are nearest to each other; 0 for what is no line.
std::pair<double, double> feet(const PlacedPoint& a, const PlacedPoint& b) {
  constexpr double parallel = 1e-3;  // sine below which the foot on the first line may lie anywhere
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

InsFactRows tape_rows(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, const InsTape& tape) {
  const Snapshot s = snapshot(problem, layout, x, tape.at);
  const PointMover mover(layout, x, s);
  const PlacedPoint a = mover.place(tape.from), b = mover.place(tape.to);
  const auto [on_a, on_b] = feet(a, b);
  const Vec3 across = (b.position + on_b * b.direction) - (a.position + on_a * a.direction);
  const double distance = across.norm();
  const Vec3 n = distance > 1e-9 ? Vec3(across / distance) : Vec3(Vec3::UnitX());
  // The feet wander along their lines, which n stands across: only the lines' own movement counts.
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
  const InsTouch& fact = problem.facts.touches[touch];
  const Snapshot s = snapshot(problem, layout, x, time);
  const PointMover mover(layout, x, s);
  PlacedPoint p = mover.place(fact.point);
  p.by_position.middleCols<3>(mover.local() + first_touch(problem, layout) + 3 * static_cast<Index>(touch)) -=
      Mat3::Identity();
  return scaled(s.interval, x.facts.touched[touch] - p.position, p.by_position, fact.sd);
}

InsFactRows surveyed_rows(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                          const InsSurveyed& fact) {
  const Snapshot s = snapshot(problem, layout, x, fact.at);
  const PointMover mover(layout, x, s);
  PlacedPoint p = mover.place(fact.point);
  const Index frame = mover.local() + first_of_surveyor(problem, layout);
  p.by_position.middleCols<3>(frame) -= Mat3::Identity();
  p.by_position.middleCols<3>(frame + 3) += x.facts.surveyor.rotation * skew(fact.xyz);
  return scaled(s.interval, x.facts.surveyor * fact.xyz - p.position, p.by_position, fact.sd);
}

}  // namespace

std::vector<InsFactRows> fact_rows(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x) {
  std::vector<InsFactRows> rows;
  for (std::size_t t = 0; t < problem.facts.touches.size(); ++t)
    for (const double time : problem.facts.touches[t].at) rows.push_back(touch_rows(problem, layout, x, t, time));
  for (const InsTape& tape : problem.facts.tapes) rows.push_back(tape_rows(problem, layout, x, tape));
  for (const InsSurveyed& fact : problem.facts.surveyed) rows.push_back(surveyed_rows(problem, layout, x, fact));
  return rows;
}

double fact_cost(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x) {
  double sum = 0.0;
  for (const InsFactRows& rows : fact_rows(problem, layout, x)) sum += rows.left.squaredNorm();
  return sum;
}

Vec3 placed_point(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, const InsPoint& point,
                  double time) {
  const Snapshot s = snapshot(problem, layout, x, time);
  return PointMover(layout, x, s).place(point).position;
}

InsFactUnknowns started_facts(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x) {
  InsUnknowns with_places = x;
  InsFactUnknowns& start = with_places.facts;
  start = {};
  for (const InsPlace& place : problem.facts.places) start.places.push_back(place.start);
  for (const InsTouch& touch : problem.facts.touches) {
    Vec3 sum = Vec3::Zero();
    for (const double time : touch.at) sum += placed_point(problem, layout, with_places, touch.point, time);
    start.touched.push_back(sum / static_cast<double>(touch.at.size()));
  }
  std::vector<Vec3> machine, surveyor;
  for (const InsSurveyed& fact : problem.facts.surveyed) {
    machine.push_back(placed_point(problem, layout, with_places, fact.point, fact.at));
    surveyor.push_back(fact.xyz);
  }
  if (machine.size() >= 3) start.surveyor = align_points(machine, surveyor);
  return start;
}

}  // namespace kinfer
