// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/start/unknown_robot.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/base/expect.hpp"
#include "kinfer/calibrate/start/local_poe.hpp"
#include "kinfer/kinematics/dh_conversion.hpp"

namespace kinfer::calibrate {
namespace {

double round_to(double value, double unit) {
  return unit * std::round(value / unit);
}

/// Lengths to 1 mm, angles to 1°; nearly parallel and nearly perpendicular axes become exactly so.
void round_link(MdhLink& row) {
  constexpr double square = 90.0 * degree, nearly = 1.0 * degree;
  for (double* length : {&row.a, &row.d}) *length = round_to(*length, 1e-3);
  row.theta = round_to(row.theta, degree);
  row.alpha = std::abs(row.alpha - round_to(row.alpha, square)) < nearly ? round_to(row.alpha, square)
                                                                         : round_to(row.alpha, degree);
  row.beta = std::abs(row.beta) < nearly ? 0.0 : round_to(row.beta, degree);
}

Chain round_to_data_sheet(Chain chain) {
  for (Joint& joint : chain.joints) round_link(std::get<MdhLink>(joint.link));
  chain.base =
      Frame::from_pose({chain.base.rotation, chain.base.xyz.unaryExpr([](double v) { return round_to(v, 1e-2); })});
  chain.tool.xyz = chain.tool.xyz.unaryExpr([](double v) { return round_to(v, 1e-3); });
  return chain;
}

std::string describe_joint_pair(const Chain& chain, std::size_t i) {
  return fmt::format("{} and {}", chain.joints[i - 1].name, chain.joints[i].name);
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

}  // namespace

std::vector<std::string> describe_axes(const Chain& chain) {
  constexpr double slack = 1e-3;  // [m]: below this, drawings show axes as intersecting
  const std::vector<AxisLine> lines = axis_lines(chain);
  std::vector<std::string> words;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const AxisLine &a = lines[i - 1], &b = lines[i];
    const double angle = angle_between(a.direction, b.direction);
    const double tilt = std::min(angle, std::numbers::pi - angle);
    const std::string pair = describe_joint_pair(chain, i);
    if (nearly_parallel(a, b)) {
      const double apart = (b.point - a.point).cross(a.direction).norm();
      words.push_back(
          b.is_prismatic || a.is_prismatic
              ? fmt::format("{} are parallel ({:.3f} deg)", pair, tilt / degree)
              : fmt::format("{} are parallel ({:.3f} deg), {:.2f} mm apart", pair, tilt / degree, 1e3 * apart));
      continue;
    }
    const std::string crossing = fmt::format("at {:.2f} deg", angle / degree);
    if (a.is_prismatic || b.is_prismatic) {
      words.push_back(fmt::format("{} are {} to each other", pair, crossing));
      continue;
    }
    const double apart = (common_normal_foot(a, b) - common_normal_foot(b, a)).norm();
    words.push_back(apart < slack ? fmt::format("{} intersect ({:.3f} mm) {}", pair, 1e3 * apart, crossing)
                                  : fmt::format("{} pass each other {:.2f} mm apart, {}", pair, 1e3 * apart, crossing));
  }
  for (std::size_t i = 2; i < lines.size(); ++i)
    if (!lines[i].is_prismatic && !lines[i - 1].is_prismatic && !lines[i - 2].is_prismatic &&
        axes_intersect(lines[i - 2], lines[i - 1], lines[i], slack))
      words.push_back(fmt::format("{}, {} and {} meet in one point: a wrist", chain.joints[i - 2].name,
                                  chain.joints[i - 1].name, chain.joints[i].name));
  return words;
}

void conclude_without_nominal(Calibration& calibration) {
  const ErrorStatistics &seen = calibration.after.position.train, &unseen = calibration.after.position.holdout;
  constexpr double believable = 3.0;  // times the error on fitted rows; beyond: overfitting
  calibration.usable = unseen.n > 0 && unseen.mean <= believable * seen.mean;
  calibration.verdict = fmt::format(
      "{}: the robot was found without a data sheet; on poses that were not fitted the tool is {:.3f} mm off on "
      "average "
      "and {:.3f} mm at worst, on fitted ones {:.3f} mm on average.",
      calibration.usable ? "Use it" : "Do not use", 1e3 * unseen.mean, 1e3 * unseen.max, 1e3 * seen.mean);
}

Result<UnknownRobot> estimate_unknown_robot(const std::string& joint_types, const PoseSet& data, int threads, Rng rng) {
  KINFER_TRY(types, parse_joint_types(joint_types));
  KINFER_TRY(found, fit_local_poe(types, data, threads, rng));
  UnknownRobot robot;
  const auto mdh = as_mdh(found.chain);
  KINFER_EXPECT(mdh.has_value(), "a chain of {} free joints is straight", types.size());
  robot.nominal = round_to_data_sheet(*mdh);
  robot.tolerances = {.length = 1e-3, .angle = 0.7 * degree, .tool_length = 5e-3};
  robot.words.push_back(fmt::format(
      "the robot was found from its joint types and the measurements: {} of {} generic starts came to the same chain, "
      "which leaves {:.3f} mm; a data sheet rounded to 1 mm and 1 deg was the nominal model",
      found.agreeing, found.starts, 1e3 * found.median_error));
  for (const std::string& line : describe_axes(found.chain)) robot.words.push_back(line);
  return robot;
}

}  // namespace kinfer::calibrate
