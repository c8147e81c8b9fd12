// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/pair_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "kinfer/base/expect.hpp"
#include "kinfer/identify/structure/thresholds.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

constexpr int heading_starts = 24;   // around the circle
constexpr int part_sweeps = 2;       // over the headings of the parts between gaps
constexpr int whitening_passes = 2;  // passes weighted by the residual's covariance

/// The numbers of a WorldRotation, with an offset of the heading for each part of the rows between gaps.
struct WorldNumbers {
  double angle = 0.0, drift = 0.0;  // [rad], [rad/s]
  Vec2 tilt = Vec2::Zero();
  std::vector<double> offsets;  // [rad]
};

/// Coarse grid of headings, then pattern search in angle, drift and tilt with halved steps. The heading of a part
/// behind a gap is scanned around the circle, too; that of the longest part is zero by definition.
WorldRotation search_world_rotation(const PairProblem& problem) {
  constexpr double coarse = 2.0 * std::numbers::pi / heading_starts, min_step = 1e-4;
  const std::vector<std::size_t>& parts = problem.parts();
  const auto longest = static_cast<std::size_t>(std::ranges::max_element(parts) - parts.begin());
  const auto rotation_of = [&](const WorldNumbers& x) {
    return problem.world_rotation(x.angle, x.drift, x.tilt, x.offsets);
  };
  WorldNumbers best{.offsets = std::vector<double>(parts.size(), 0.0)};
  double least = problem.cost(rotation_of(best));
  const auto improves = [&](WorldNumbers trial) {
    const double cost = problem.cost(rotation_of(trial));
    if (!(cost < least)) return false;
    best = std::move(trial);
    least = cost;
    return true;
  };
  const auto changed = [&](double angle, double drift, const Vec2& tilt) {
    return WorldNumbers{best.angle + angle, best.drift + drift, best.tilt + tilt, best.offsets};
  };
  const auto shifted = [](WorldNumbers x, std::size_t part, double by) {
    x.offsets[part] += by;
    return x;
  };
  const auto scan_angle = [&, start = best] {
    for (int k = 1; k < heading_starts; ++k) {
      WorldNumbers trial = best;
      trial.angle = start.angle + k * coarse;
      improves(std::move(trial));
    }
  };
  const auto scan_part = [&](std::size_t part) {
    std::vector<WorldNumbers> around;  // the best one, whichever is better meanwhile
    for (int k = 1; k < heading_starts; ++k) around.push_back(shifted(best, part, k * coarse));
    for (WorldNumbers& trial : around) improves(std::move(trial));
  };
  const auto improves_part = [&](double step) {
    for (std::size_t part = 0; part < parts.size(); ++part)
      if (part != longest && (improves(shifted(best, part, step)) || improves(shifted(best, part, -step)))) return true;
    return false;
  };
  scan_angle();
  for (int sweep = 0; sweep < part_sweeps && parts.size() > 1; ++sweep) {
    for (std::size_t part = 0; part < parts.size(); ++part)
      if (part != longest) scan_part(part);
    scan_angle();
  }
  const Vec2 level = Vec2::Zero(), x = Vec2::UnitX(), y = Vec2::UnitY();
  for (double step = 0.5 * coarse; step > min_step;) {
    const double drift_step = 0.01 * step, tilt_step = 0.1 * step;  // [rad/s] for a log of minutes; [rad]
    const bool better = improves(changed(step, 0.0, level)) || improves(changed(-step, 0.0, level)) ||
                        improves(changed(0.0, drift_step, level)) || improves(changed(0.0, -drift_step, level)) ||
                        improves(changed(0.0, 0.0, tilt_step * x)) || improves(changed(0.0, 0.0, -tilt_step * x)) ||
                        improves(changed(0.0, 0.0, tilt_step * y)) || improves(changed(0.0, 0.0, -tilt_step * y)) ||
                        improves_part(step);
    if (!better) step *= 0.5;
  }
  return rotation_of(best);
}

/// Inverse of the mean square plus the floor's, scaled to the identity if isotropic.
Mat3 whitening(const Mat3& mean_square, double floor) {
  const MatrixXd inverse = invert_but_for_rounding(mean_square + floor * floor * Mat3::Identity());
  return 3.0 / inverse.trace() * inverse;
}

/// The part of a relative rotation's code that tells nothing about neighbours: a joint rotates about one axis, and how
/// far is the machine's business. Without it, the bars of a parallelogram, of which two never rotate relative to each
/// other, are nearer to each other than to those that they turn on.
double uninformative_rotation(const Mat3& mean_square) {
  const double ratio = symmetric_eigen(mean_square).values[2] / (pair_rate_floor * pair_rate_floor);
  return std::max(0.0, 0.5 * std::log1p(std::max(0.0, ratio)) - informative_rotation);
}

}  // namespace

PairFit fit_pair(const RecordedMotion& motion, std::size_t first, std::size_t second,
                 const std::vector<std::size_t>& rows, HeadingReference headings) {
  KINFER_EXPECT(rows.size() >= 50, "{} rows", rows.size());
  const PairProblem problem(motion, first, second, rows, headings);
  const WorldRotation world_rotation = search_world_rotation(problem);
  PairFit fit{.first = first, .second = second, .heading = world_rotation.heading, .tilt = world_rotation.tilt};
  fit.angular_velocity = problem.mean_square_rate(world_rotation);
  problem.solve(fit, Mat3::Identity());
  for (int k = 0; k < whitening_passes; ++k) problem.solve(fit, whitening(fit.acceleration, pair_acceleration_floor));
  fit.distance = code_length(fit.acceleration, pair_acceleration_floor) +
                 code_length(fit.angular_velocity, pair_rate_floor) - uninformative_rotation(fit.angular_velocity);
  return fit;
}

}  // namespace kinfer::identify
