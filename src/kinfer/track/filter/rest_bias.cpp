// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/filter/rest_bias.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/square.hpp"
#include "kinfer/track/filter/thresholds.hpp"

namespace kinfer::track {
namespace {

double variance(const Vec3& sum, const Vec3& square, int count) {
  return (square / count - (sum / count).cwiseAbs2()).maxCoeff();
}

/// Even odds of a rest and of a steady rotation, which also is quiet: by the density of the mean rate in either case.
bool is_rest(double rate, double variance) {
  const auto log_density = [&](double v) { return -0.5 * (rate * rate / v + std::log(v)); };
  return log_density(variance) > log_density(variance + square(steady_rate));
}

}  // namespace

RestBias::RestBias(const FilterModel& model) {
  for (const SensorSettings& s : model.sensors) noise_.push_back(s.white);
  const auto n = model.sensors.size();
  const std::vector<Vec3> zero(n, Vec3::Zero());
  open_ = {.sum = zero,
           .square = zero,
           .force_sum = zero,
           .force_square = zero,
           .count = std::vector<int>(n, 0),
           .is_quiet = std::vector<bool>(n, false)};
  last_.fill(open_);
}

bool RestBias::is_quiet(const Block& block, std::size_t s) const {
  if (block.count[s] < min_rest_rows) return false;
  const double rate = rest_noise * noise_[s].rate, force = rest_noise * noise_[s].force;
  return variance(block.sum[s], block.square[s], block.count[s]) <= rate * rate &&
         variance(block.force_sum[s], block.force_square[s], block.count[s]) <= force * force;
}

bool RestBias::rests(std::size_t sensor) const {
  return std::ranges::all_of(last_, [&](const Block& block) { return block.is_quiet[sensor]; });
}

void RestBias::close() {
  for (std::size_t s = 0; s < noise_.size(); ++s) open_.is_quiet[s] = is_quiet(open_, s);
  std::swap(last_[0], last_[1]);
  std::swap(last_[1], last_[2]);
  std::swap(last_[2], open_);
  for (std::size_t s = 0; s < noise_.size(); ++s) {
    open_.sum[s] = open_.square[s] = open_.force_sum[s] = open_.force_square[s] = Vec3::Zero();
    open_.count[s] = 0;
  }
  open_.rows = 0;
}

bool RestBias::add(const InsRow& row) {
  bool is_rest = false;
  if (open_.rows > 0 && row.time - open_.begin >= rest_block) {
    close();
    for (std::size_t s = 0; s < noise_.size(); ++s) is_rest |= rests(s);
  }
  if (open_.rows == 0) open_.begin = row.time;
  ++open_.rows;
  for (std::size_t s = 0; s < noise_.size(); ++s) {
    const InsSample& sample = row.sensors[s];
    if (!sample.has_angular_velocity || !sample.has_acceleration) continue;
    open_.sum[s] += sample.angular_velocity;
    open_.square[s] += sample.angular_velocity.cwiseAbs2();
    open_.force_sum[s] += sample.acceleration;
    open_.force_square[s] += sample.acceleration.cwiseAbs2();
    ++open_.count[s];
  }
  return is_rest;
}

Vec3 RestBias::mean_rate(std::size_t s) const {
  return last_[1].sum[s] / last_[1].count[s];
}

/// Difference of the biases of a joint's sensors along its axis.
ChainFilter::ScalarRow RestBias::bias_row(const ChainFilter& filter, const InsBody& joint) const {
  const FilterModel& model = filter.model();
  const int parent = model.bodies[static_cast<std::size_t>(joint.parent)].sensor;
  const auto p = static_cast<std::size_t>(parent), c = static_cast<std::size_t>(joint.sensor);
  const Vec3 a = joint.parent_R_axis.col(2), b = joint.child_R_axis.col(2);
  ChainFilter::ScalarRow row;
  for (Index k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    row.at[i] = model.layout.sensor_state(joint.sensor) + SensorIndex::gyroscope_bias + k;
    row.at[i + 3] = model.layout.sensor_state(parent) + SensorIndex::gyroscope_bias + k;
    row.factor[i] = b[k];
    row.factor[i + 3] = -a[k];
  }
  row.terms = 6;
  row.innovation = b.dot(mean_rate(c) - filter.state().sensors[c].gyroscope_bias) -
                   a.dot(mean_rate(p) - filter.state().sensors[p].gyroscope_bias);
  row.variance =
      square(noise_[c].rate) / last_[1].count[c] + square(noise_[p].rate) / last_[1].count[p] + square(rest_creep);
  return row;
}

void RestBias::correct(ChainFilter& filter) const {
  const FilterModel& model = filter.model();
  for (const InsBody& body : model.bodies) {
    if (body.motion != JointMotion::revolute || body.sensor < 0) continue;
    const int parent = model.bodies[static_cast<std::size_t>(body.parent)].sensor;
    if (parent < 0) continue;
    const auto p = static_cast<std::size_t>(parent), c = static_cast<std::size_t>(body.sensor);
    if (!filter.uses_sensor(p) || !filter.uses_sensor(c) || !rests(p) || !rests(c)) continue;
    const ChainFilter::ScalarRow row = bias_row(filter, body);
    if (is_rest(row.innovation, filter.variance(row))) filter.update(row);
  }
}

}  // namespace kinfer::track
