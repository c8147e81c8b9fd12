// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/geometry/link_estimates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "kinfer/geometry/rotation.hpp"
#include "kinfer/identify/geometry/thresholds.hpp"

namespace kinfer::identify {
namespace {

/// One end of a link: an axis line, or a centre, in the sensor's frame. Standard deviations in the two directions
/// across the axis, as JointStandardDeviation has them.
struct LinkEnd {
  Vec3 point = Vec3::Zero(), axis = Vec3::Zero();  // axis zero: a centre
  std::array<double, 2> point_sd{}, axis_sd{};
};

double mean_sd(const std::array<double, 2>& sd) {
  return std::hypot(sd[0], sd[1]) / std::sqrt(2.0);
}

/// Probability that two axes, whose directions include an angle of this sine measured with standard deviation `sd`, are
/// not exactly parallel: the angle is Rayleigh distributed, with `sd` if they are, and with the machine's misalignment
/// besides if they are not.
double probability_of_skew(double sine, double sd) {
  if (sd <= 0.0) return sine > 0.0 ? 1.0 : 0.0;
  const double measured = sd * sd, built = built_misalignment * built_misalignment;
  const double log_odds =
      std::log(measured / (measured + built)) + 0.5 * sine * sine / measured * built / (measured + built);
  return 1.0 / (1.0 + std::exp(-log_odds));
}

std::pair<double, double> distance_of_parallel_lines(const LinkEnd& a, const LinkEnd& b) {
  const Vec3 between = b.point - a.point, along = a.axis.norm() > 0.5 ? a.axis : b.axis;
  return {(between - along.dot(between) * along).norm(), std::hypot(mean_sd(a.point_sd), mean_sd(b.point_sd))};
}

/// The closest points of nearly parallel lines are far away and depend on the small angle between the lines; the
/// standard deviation contains this.
std::pair<double, double> distance_of_skew_lines(const LinkEnd& a, const LinkEnd& b) {
  const Vec3 between = b.point - a.point, across = a.axis.cross(b.axis), normal = across.normalized();
  const double offset_along_axis = between.dot(normal.cross(a.axis));
  const double point_sd = std::hypot(mean_sd(a.point_sd), mean_sd(b.point_sd));
  const double axis_sd = std::hypot(mean_sd(a.axis_sd), mean_sd(b.axis_sd));
  return {std::abs(between.dot(normal)), std::hypot(point_sd, offset_along_axis * axis_sd / across.norm())};
}

/// Shortest distance of two lines, or of a centre and a line, and its standard deviation.
std::pair<double, double> shortest_distance(const LinkEnd& a, const LinkEnd& b) {
  constexpr double rounding = 1e-12;  // of a unit vector's cross product
  const double sine = a.axis.cross(b.axis).norm();
  const auto parallel = distance_of_parallel_lines(a, b);
  if (sine < rounding) return parallel;
  const double probability = probability_of_skew(sine, std::hypot(mean_sd(a.axis_sd), mean_sd(b.axis_sd)));
  if (probability < parallel_probability) return parallel;
  const auto skew = distance_of_skew_lines(a, b);
  if (probability > skew_probability) return skew;
  return {skew.first, std::hypot(skew.second, skew.first - parallel.first)};
}

/// Whether the axes are parallel as machines are built, rather than at any angle: an angle of two directions at random
/// has the density sin x, that of two axes built parallel is Rayleigh distributed.
bool are_meant_parallel(double angle, double sd) {
  const double variance = built_misalignment * built_misalignment + sd * sd;
  return std::exp(-0.5 * angle * angle / variance) / variance > std::sin(angle) / std::max(angle, 1e-12);
}

/// Where a line meets the plane through the sensor's origin across `normal`.
struct Pin {
  Vec3 point = Vec3::Zero();
  double along = 0.0;  // [m] from the line's point to it

  Pin(const LinkEnd& line, const Vec3& normal) : along(-normal.dot(line.point) / normal.dot(line.axis)) {
    point = line.point + along * line.axis;
  }
};

/// Variance of a pin's position along a direction across its axis.
double variance_along(const LinkEnd& line, const Pin& pin, const Vec3& direction) {
  const Vec3 first = any_perpendicular(line.axis);
  const std::array<double, 2> share{direction.dot(first), direction.dot(line.axis.cross(first))};
  double sum = 0.0;
  for (const std::size_t k : {0u, 1u})
    sum += share[k] * share[k] * (std::pow(line.point_sd[k], 2) + std::pow(pin.along * line.axis_sd[k], 2));
  return sum;
}

PinDistance pin_distance(const LinkEnd& a, const LinkEnd& b) {
  const Vec3 mean_axis = (a.axis + (a.axis.dot(b.axis) < 0.0 ? -1.0 : 1.0) * b.axis).normalized();
  const Pin first(a, mean_axis), second(b, mean_axis);
  const Vec3 between = second.point - first.point;
  const auto sd_along = [&](const Vec3& direction) {
    return std::sqrt(variance_along(a, first, direction) + variance_along(b, second, direction));
  };
  PinDistance pins{.distance = between.norm()};
  pins.direction = pins.distance > 0.0 ? Vec3(between / pins.distance) : any_perpendicular(mean_axis);
  pins.sd = sd_along(pins.direction);
  pins.direction_sd = pins.distance > 0.0 ? sd_along(mean_axis.cross(pins.direction)) / pins.distance
                                          : std::numeric_limits<double>::infinity();
  return pins;
}

LinkEnd link_end(const JointEstimate& joint, const Vec3& point, const Vec3& axis, const std::array<double, 2>& point_sd,
                 const std::array<double, 2>& axis_sd) {
  const bool has_axis = joint.type != EstimatedJointType::spherical;
  return {point, has_axis ? axis : Vec3(Vec3::Zero()), point_sd, has_axis ? axis_sd : std::array<double, 2>{}};
}

LinkEstimate link_between(const JointEstimate& from, const JointEstimate& to) {
  const LinkEnd a =
      link_end(from, from.point_in_child, from.axis_in_child, from.sd.point_in_child, from.sd.axis_in_child);
  const LinkEnd b = link_end(to, to.point_in_parent, to.axis_in_parent, to.sd.point_in_parent, to.sd.axis_in_parent);
  LinkEstimate link{.segment = from.child, .from = joint_name(from), .to = joint_name(to)};
  std::tie(link.length, link.sd) = shortest_distance(a, b);
  const bool both_have_axes = a.axis.norm() > 0.5 && b.axis.norm() > 0.5;
  link.axis_angle = both_have_axes ? std::atan2(a.axis.cross(b.axis).norm(), std::abs(a.axis.dot(b.axis)))
                                   : std::numeric_limits<double>::quiet_NaN();
  if (both_have_axes && are_meant_parallel(link.axis_angle, std::hypot(mean_sd(a.axis_sd), mean_sd(b.axis_sd))))
    link.pin = pin_distance(a, b);
  return link;
}

}  // namespace

std::vector<LinkEstimate> link_estimates(const std::vector<JointEstimate>& joints) {
  const auto rotates = [](const JointEstimate& j) {
    return j.type == EstimatedJointType::revolute || j.type == EstimatedJointType::spherical;
  };
  std::vector<LinkEstimate> links;
  for (const JointEstimate& to : joints)
    for (const JointEstimate& from : joints)
      if (from.child == to.parent && rotates(from) && rotates(to)) links.push_back(link_between(from, to));
  return links;
}

}  // namespace kinfer::identify
