// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/pair_relation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinfer/geometry/rotation.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

/// Rows near the split, where smoothing mixes before and after.
bool is_near_split(std::size_t row, std::size_t split) {
  return row + 2 >= split && row < split + 2;
}

Index column(std::size_t sensor, std::size_t part, SplitSensors split_sensors) {
  const bool own = sensor == 0 ? split_sensors.first : split_sensors.second;
  return static_cast<Index>(6 * sensor + (own ? 3 * part : 0));
}

}  // namespace

RelationRows relation_rows(const SegmentMotion& m, const std::vector<std::size_t>& at, const MountRelation& relation,
                           double gravity) {
  RelationRows rows;
  for (const std::size_t i : at) {
    const Mat3 to_sensor = m.rotation[i].transpose();
    const Vec3 angular_velocity = to_sensor * m.angular_velocity[i];
    if (relation.is_direction) {
      rows.push_back({Vec3::Zero(), skew(angular_velocity)});
      continue;
    }
    const Mat3 rate_skew = skew(angular_velocity);
    rows.push_back({to_sensor * (m.acceleration[i] + Vec3(0.0, 0.0, gravity)),
                    skew(to_sensor * m.angular_acceleration[i]) + rate_skew * rate_skew});
  }
  return rows;
}

SplitFit PairRelation::fit(std::size_t split, SplitSensors split_sensors) const {
  SplitFit best{.p = {}, .rms = std::numeric_limits<double>::infinity()};
  for (const Vec3& first : starts())
    for (const Vec3& second : starts()) {
      const SplitFit found = fit_from({{{first, first}, {second, second}}}, split, split_sensors);
      if (found.rms < best.rms) best = found;
    }
  return best;
}

double PairRelation::rms_across(const SplitFit& fit, std::size_t split, std::size_t part) const {
  constexpr int directions = 6;
  const Vec3 one = fit.p[1][part].unitOrthogonal(), other = fit.p[1][part].cross(one);
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < directions; ++k) {
    const double angle = std::numbers::pi * k / directions;
    SplitParameters across = fit.p;
    across[1][part] = std::cos(angle) * one + std::sin(angle) * other;
    least = std::min(least, rms(across, split));
  }
  return least;
}

std::vector<Vec3> PairRelation::starts() const {
  if (!relation_.is_direction) return {Vec3::Zero()};
  return {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
}

double PairRelation::residual(const SplitParameters& p, std::size_t row, std::size_t part) const {
  std::array<double, 2> norm{};
  for (std::size_t s = 0; s < 2; ++s) {
    const RelationRow& r = (*rows_of_sensors_[s])[row];
    norm[s] = (r.constant + r.jacobian * p[s][part]).norm();
  }
  return norm[0] - norm[1];
}

double PairRelation::rms(const SplitParameters& p, std::size_t split) const {
  double sum = 0.0;
  for (std::size_t row = 0; row < rows_of_sensors_[0]->size(); ++row)
    if (!is_near_split(row, split))
      sum += std::pow(std::min(std::abs(residual(p, row, row >= split)), 5.0 * relation_.huber_threshold), 2);
  return std::sqrt(sum / static_cast<double>(rows_of_sensors_[0]->size()));
}

SplitFit PairRelation::fit_from(const SplitParameters& p, std::size_t split, SplitSensors split_sensors) const {
  constexpr int iterations = 12;
  SplitFit best{p, rms(p, split)};
  double damping = 1e-3;
  for (int i = 0; i < iterations; ++i) {
    MatrixXd matrix = MatrixXd::Zero(12, 12);
    VectorXd right = VectorXd::Zero(12);
    accumulate(best.p, split, split_sensors, matrix, right);
    matrix.diagonal() *= 1.0 + damping;
    matrix.diagonal().array() += 1e-6;
    const auto step = solve_spd(matrix, right);
    if (!step) break;
    const SplitParameters trial = updated(best.p, *step, split_sensors);
    const double error = rms(trial, split);
    const bool better = error < best.rms;
    const bool done = better && best.rms - error < 1e-4 * best.rms;
    if (better) best = {trial, error};
    damping = better ? 0.1 * damping : 10.0 * damping;
    if (done || damping > 1e6) break;
  }
  return best;
}

void PairRelation::accumulate(const SplitParameters& p, std::size_t split, SplitSensors split_sensors, MatrixXd& matrix,
                              VectorXd& right) const {
  for (std::size_t row = 0; row < rows_of_sensors_[0]->size(); ++row) {
    if (is_near_split(row, split)) continue;
    const std::size_t part = row >= split;
    std::array<Vec3, 2> slope;
    std::array<double, 2> norm{};
    for (std::size_t s = 0; s < 2; ++s) {
      const RelationRow& r = (*rows_of_sensors_[s])[row];
      const Vec3 v = r.constant + r.jacobian * p[s][part];
      norm[s] = v.norm();
      slope[s] = (s == 0 ? 1.0 : -1.0) / std::max(norm[s], 1e-9) * (r.jacobian.transpose() * v);
    }
    const double e = norm[0] - norm[1],
                 weight = std::min(1.0, relation_.huber_threshold / std::max(std::abs(e), 1e-12));
    const std::array<Index, 2> at{column(0, part, split_sensors), column(1, part, split_sensors)};
    for (std::size_t s = 0; s < 2; ++s) {
      right.segment<3>(at[s]) -= weight * e * slope[s];
      for (std::size_t k = 0; k < 2; ++k) matrix.block<3, 3>(at[s], at[k]) += weight * slope[s] * slope[k].transpose();
    }
  }
  for (std::size_t s = 0; s < 2; ++s)
    for (std::size_t part = 0; part < 2; ++part) {
      const Index at = column(s, part, split_sensors);
      matrix.diagonal().segment<3>(at).array() += relation_.prior_weight;
      right.segment<3>(at) -= relation_.prior_weight * p[s][part];
    }
  for (std::size_t s = 0; s < 2 && relation_.is_direction; ++s)  // unit length of directions
    for (std::size_t part = 0; part < 2; ++part) {
      const Index at = column(s, part, split_sensors);
      matrix.block<3, 3>(at, at) +=
          static_cast<double>(rows_of_sensors_[0]->size()) * p[s][part] * p[s][part].transpose();
    }
}

SplitParameters PairRelation::updated(SplitParameters p, const VectorXd& step, SplitSensors split_sensors) const {
  for (std::size_t s = 0; s < 2; ++s)
    for (std::size_t part = 0; part < 2; ++part) {
      p[s][part] += step.segment<3>(column(s, part, split_sensors));
      if (relation_.is_direction) p[s][part].normalize();
    }
  return p;
}

}  // namespace kinfer::identify
