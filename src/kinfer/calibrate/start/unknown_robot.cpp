// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/start/unknown_robot.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/base/expect.hpp"
#include "kinfer/calibrate/start/local_poe.hpp"
#include "kinfer/calibrate/start/thresholds.hpp"
#include "kinfer/kinematics/dh_conversion.hpp"

namespace kinfer::calibrate {
namespace {

double round_to(double value, double unit) {
  return unit * std::round(value / unit);
}

/// Lengths to 1 mm, angles to 1°; nearly parallel and nearly perpendicular axes become exactly so.
void round_link(MdhLink& row) {
  constexpr double square = 90.0 * degree, nearly = thresholds::sheet_angle;
  for (double* length : {&row.a, &row.d}) *length = round_to(*length, thresholds::sheet_length);
  row.theta = round_to(row.theta, thresholds::sheet_angle);
  row.alpha = std::abs(row.alpha - round_to(row.alpha, square)) < nearly ? round_to(row.alpha, square)
                                                                         : round_to(row.alpha, thresholds::sheet_angle);
  row.beta = std::abs(row.beta) < nearly ? 0.0 : round_to(row.beta, thresholds::sheet_angle);
}

Chain round_to_data_sheet(Chain chain) {
  for (Joint& joint : chain.joints) round_link(std::get<MdhLink>(joint.link));
  chain.base = Frame::from_pose(
      {chain.base.rotation, chain.base.xyz.unaryExpr([](double v) { return round_to(v, thresholds::base_length); })});
  chain.tool.xyz = chain.tool.xyz.unaryExpr([](double v) { return round_to(v, thresholds::sheet_length); });
  return chain;
}

/// Whether three axes intersect in one point: a spherical wrist.
bool axes_intersect(const AxisLine& a, const AxisLine& b, const AxisLine& c, double slack) {
  if (nearly_parallel(a, b) || nearly_parallel(b, c)) return false;
  const Vec3 p = common_normal_foot(b, a), q = common_normal_foot(b, c);
  const auto off = [](const AxisLine& line, const Vec3& point) {
    return (point - line.point).cross(line.direction).norm();
  };
  return (p - q).norm() < slack && off(a, p) < slack && off(c, q) < slack;
}

bool is_wrist(const AxisLine& a, const AxisLine& b, const AxisLine& c) {
  const bool revolute = !a.is_prismatic && !b.is_prismatic && !c.is_prismatic;
  return revolute && axes_intersect(a, b, c, thresholds::intersecting_axes);
}

AxisPair relate(const AxisLine& a, const AxisLine& b) {
  const double angle = angle_between(a.direction, b.direction);
  const bool prismatic = a.is_prismatic || b.is_prismatic;
  if (nearly_parallel(a, b)) {
    AxisPair pair{.relation = AxisRelation::parallel, .angle = std::min(angle, std::numbers::pi - angle)};
    if (!prismatic) pair.distance = (b.point - a.point).cross(a.direction).norm();
    return pair;
  }
  if (prismatic) return {.relation = AxisRelation::at_angle, .angle = angle};
  const double distance = (common_normal_foot(a, b) - common_normal_foot(b, a)).norm();
  const bool intersect = distance < thresholds::intersecting_axes;
  return {
      .relation = intersect ? AxisRelation::intersecting : AxisRelation::skew, .angle = angle, .distance = distance};
}

}  // namespace

AxisGeometry axis_geometry(const Chain& chain) {
  const std::vector<AxisLine> lines = axis_lines(chain);
  const auto joint = [&](std::size_t i) { return chain.joints[i].name; };
  AxisGeometry axes;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    AxisPair pair = relate(lines[i - 1], lines[i]);
    pair.first = joint(i - 1), pair.second = joint(i);
    axes.pairs.push_back(pair);
  }
  for (std::size_t i = 2; i < lines.size(); ++i)
    if (is_wrist(lines[i - 2], lines[i - 1], lines[i])) axes.wrists.push_back({joint(i - 2), joint(i - 1), joint(i)});
  return axes;
}

Result<UnknownRobot> estimate_unknown_robot(const std::vector<JointType>& joint_types, const PoseSet& data, int threads,
                                            Rng rng) {
  KINFER_TRY(found, fit_local_poe(joint_types, data, threads, rng));
  const auto mdh = as_mdh(found.chain);
  KINFER_EXPECT(mdh.has_value(), "a chain of {} free joints is straight", joint_types.size());
  UnknownRobot robot;
  robot.nominal = round_to_data_sheet(*mdh);
  robot.nominal.name = "unknown";
  robot.tolerances = {.length = thresholds::rounded_length,
                      .angle = thresholds::rounded_angle,
                      .tool_length = thresholds::rounded_tool};
  robot.evidence = {.starts = found.starts,
                    .agreeing = found.agreeing,
                    .median_error = found.median_error,
                    .axes = axis_geometry(found.chain)};
  return robot;
}

}  // namespace kinfer::calibrate
