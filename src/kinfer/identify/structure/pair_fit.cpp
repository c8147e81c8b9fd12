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

/// The best rotation so far. A trial that changes the heading of one part alone costs the sums of that part.
class RotationSearch {
 public:
  explicit RotationSearch(const PairProblem& problem) : problem_(problem) {
    best_.offsets.assign(problem.parts().size(), 0.0);
    sums_ = problem.sums_of_parts(rotation());
    least_ = problem.cost(sums_, rotation());
  }

  const WorldNumbers& best() const { return best_; }
  WorldRotation rotation() const { return rotation_of(best_); }

  /// Takes a rotation that costs less.
  bool improves(const WorldNumbers& trial) {
    const WorldRotation rotation = rotation_of(trial);
    return take(trial, problem_.sums_of_parts(rotation), rotation);
  }

  /// Likewise, with another heading of one part.
  bool improves_part(std::size_t part, double offset) {
    WorldNumbers trial = best_;
    trial.offsets[part] = offset;
    const WorldRotation rotation = rotation_of(trial);
    std::vector<PairProblem::PartSums> sums = sums_;
    sums[part] = problem_.sums_of(part, rotation);
    return take(trial, std::move(sums), rotation);
  }

  bool improves_by(double angle, double drift, const Vec2& tilt) {
    return improves({best_.angle + angle, best_.drift + drift, best_.tilt + tilt, best_.offsets});
  }

  bool improves_part_by(std::size_t part, double by) { return improves_part(part, best_.offsets[part] + by); }

 private:
  WorldRotation rotation_of(const WorldNumbers& x) const {
    return problem_.world_rotation(x.angle, x.drift, x.tilt, x.offsets);
  }

  bool take(const WorldNumbers& trial, std::vector<PairProblem::PartSums> sums, const WorldRotation& rotation) {
    const double cost = problem_.cost(sums, rotation);
    if (!(cost < least_)) return false;
    best_ = trial, sums_ = std::move(sums), least_ = cost;
    return true;
  }

  const PairProblem& problem_;
  WorldNumbers best_;
  std::vector<PairProblem::PartSums> sums_;  // of the best
  double least_ = 0.0;
};

/// Coarse grid of headings, then pattern search in angle, drift and tilt with halved steps. The heading of a part
/// behind a gap is scanned around the circle, too; that of the longest part is zero by definition.
WorldRotation search_world_rotation(const PairProblem& problem) {
  constexpr double coarse = 2.0 * std::numbers::pi / heading_starts, min_step = 1e-4;
  const std::vector<std::size_t>& parts = problem.parts();
  const auto longest = static_cast<std::size_t>(std::ranges::max_element(parts) - parts.begin());
  RotationSearch search(problem);
  const auto scan_angle = [&, first = search.best().angle] {
    for (int k = 1; k < heading_starts; ++k) {
      WorldNumbers trial = search.best();
      trial.angle = first + k * coarse;
      search.improves(trial);
    }
  };
  const auto for_other_parts = [&](const auto& visit) {
    bool better = false;
    for (std::size_t part = 0; part < parts.size(); ++part)
      if (part != longest) better |= visit(part);
    return better;
  };
  const auto scan_part = [&](std::size_t part) {
    const double first = search.best().offsets[part];
    bool better = false;
    for (int k = 1; k < heading_starts; ++k) better |= search.improves_part(part, first + k * coarse);
    return better;
  };
  scan_angle();
  for (int sweep = 0; sweep < part_sweeps && parts.size() > 1; ++sweep) {
    for_other_parts(scan_part);
    scan_angle();
  }
  const Vec2 level = Vec2::Zero(), x = Vec2::UnitX(), y = Vec2::UnitY();
  for (double step = 0.5 * coarse; step > min_step;) {
    const double drift_step = 0.01 * step, tilt_step = 0.1 * step;  // [rad/s] for a log of minutes; [rad]
    const bool better = search.improves_by(step, 0.0, level) || search.improves_by(-step, 0.0, level) ||
                        search.improves_by(0.0, drift_step, level) || search.improves_by(0.0, -drift_step, level) ||
                        search.improves_by(0.0, 0.0, tilt_step * x) || search.improves_by(0.0, 0.0, -tilt_step * x) ||
                        search.improves_by(0.0, 0.0, tilt_step * y) || search.improves_by(0.0, 0.0, -tilt_step * y) ||
                        for_other_parts([&](std::size_t part) {
                          return search.improves_part_by(part, step) || search.improves_part_by(part, -step);
                        });
    if (!better) step *= 0.5;
  }
  return search.rotation();
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
