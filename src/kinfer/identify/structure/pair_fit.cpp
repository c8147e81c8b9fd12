// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/pair_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/base/expect.hpp"
#include "kinfer/identify/structure/thresholds.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

constexpr int heading_starts = 24;   // around the circle
constexpr int whitening_passes = 2;  // passes weighted by the residual's covariance

/// Coarse grid of headings, then pattern search in angle, drift and tilt with halved steps.
WorldRotation search_world_rotation(const PairProblem& problem) {
  constexpr double coarse = 2.0 * std::numbers::pi / heading_starts, min_step = 1e-4;
  WorldRotation best = problem.world_rotation(0.0, 0.0, Vec2::Zero());
  double least = problem.cost(best);
  const auto try_rotation = [&](double angle, double drift, const Vec2& tilt) {
    const WorldRotation world_rotation = problem.world_rotation(angle, drift, tilt);
    const double cost = problem.cost(world_rotation);
    if (!(cost < least)) return false;
    best = world_rotation;
    least = cost;
    return true;
  };
  for (int k = 1; k < heading_starts; ++k) try_rotation(k * coarse, 0.0, Vec2::Zero());
  for (double step = 0.5 * coarse; step > min_step;) {
    const double drift_step = 0.01 * step, tilt_step = 0.1 * step;  // [rad/s] for a log of minutes; [rad]
    const auto heading = best.heading;
    const Vec2 tilt = best.tilt;
    const auto try_tilt = [&](const Vec2& by) {
      return try_rotation(heading.angle, heading.drift, tilt + tilt_step * by);
    };
    const bool better = try_rotation(heading.angle + step, heading.drift, tilt) ||
                        try_rotation(heading.angle - step, heading.drift, tilt) ||
                        try_rotation(heading.angle, heading.drift + drift_step, tilt) ||
                        try_rotation(heading.angle, heading.drift - drift_step, tilt) || try_tilt(Vec2::UnitX()) ||
                        try_tilt(-Vec2::UnitX()) || try_tilt(Vec2::UnitY()) || try_tilt(-Vec2::UnitY());
    if (!better) step *= 0.5;
  }
  return best;
}

/// Inverse of the mean square plus the floor's, scaled to the identity if isotropic.
Mat3 whitening(const Mat3& mean_square, double floor) {
  const auto inverse = invert_spd(mean_square + floor * floor * Mat3::Identity());
  KINFER_EXPECT(inverse, "a mean square plus a floor is positive definite");
  return 3.0 / inverse->trace() * *inverse;
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
