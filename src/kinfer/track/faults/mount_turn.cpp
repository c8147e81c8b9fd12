// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/faults/mount_turn.hpp"

#include <cmath>

#include "kinfer/base/square.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/measurement/pose_set.hpp"
#include "kinfer/track/faults/thresholds.hpp"

namespace kinfer::track {
namespace {

Index first_scale(const ChainFilter& filter, std::size_t sensor) {
  return filter.model().layout.sensor_state(static_cast<Index>(sensor)) + SensorIndex::gyroscope_scale;
}

/// ln of the integral of the likelihood exp(−½ θᵀ Λ θ + ηᵀ θ) over a belief.
double log_evidence(const MountTurn& belief, const Mat3& information, const Vec3& score) {
  const Mat3 m = Mat3::Identity() + belief.covariance * information, inverse = m.inverse();
  return -0.5 * std::log(m.determinant()) - 0.5 * belief.mean.dot(information * inverse * belief.mean) +
         score.dot(inverse * belief.mean) + 0.5 * score.dot(inverse * belief.covariance * score);
}

}  // namespace

void loosen_mount(ChainFilter& filter, std::size_t sensor, double variance) {
  const TurnDerivative by_turn = scales_by_turn();
  filter.widen(first_scale(filter, sensor), variance * by_turn * by_turn.transpose());
}

MountTurn mount_turn(const ChainFilter& filter, std::size_t sensor) {
  const Index scales = first_scale(filter, sensor);
  const Eigen::Matrix<double, 3, 18> mean = 0.25 * scales_by_turn().transpose();
  const SensorErrors& state = filter.state().sensors[sensor];
  const Mat3 scale = 0.5 * (state.gyroscope_scale + state.accelerometer_scale);
  const Mat3 twice = scale - scale.transpose();
  MountTurn turn{.mean = 0.5 * Vec3(twice(2, 1), twice(0, 2), twice(1, 0)),
                 .covariance = mean * filter.covariance().block<18, 18>(scales, scales) * mean.transpose()};
  turn.covariance.diagonal().array() += square(least_turn_sd);
  return turn;
}

SensorTurn size_of(const MountTurn& turn) {
  const Vec3 direction = turn.mean.normalized();
  return {.angle = turn.mean.norm(),
          .sd = std::sqrt(direction.dot(turn.covariance * direction)),
          .hidden_sd = principal_deviations(turn.covariance).sd.maxCoeff()};
}

double log_odds_of(const MountTurn& supposed, const MountTurn& before, const MountTurn& after) {
  const Mat3 known_before = before.covariance.inverse(), known_after = after.covariance.inverse();
  const Mat3 information = known_after - known_before;
  const Vec3 score = known_after * after.mean - known_before * before.mean;
  return log_evidence(supposed, information, score) - log_evidence(before, information, score);
}

}  // namespace kinfer::track
