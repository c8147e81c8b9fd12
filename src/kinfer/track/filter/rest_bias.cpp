// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/filter/rest_bias.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/track/filter/thresholds.hpp"

namespace kinfer::track {
namespace {

double variance(const Vec3& sum, const Vec3& square, int count) {
  return (square / count - (sum / count).cwiseAbs2()).maxCoeff();
}

}  // namespace

RestBias::RestBias(const FilterModel& model) {
  for (const SensorSettings& s : model.sensors) noise_.push_back(s.white);
  const auto n = model.sensors.size();
  const std::vector<Vec3> zero(n, Vec3::Zero());
  open_ = {.sum = zero, .square = zero, .force_sum = zero, .force_square = zero, .count = std::vector<int>(n, 0)};
  last_.fill(open_);
}

bool RestBias::is_quiet(const Block& block) const {
  if (block.rows < min_rest_rows) return false;
  for (std::size_t s = 0; s < noise_.size(); ++s) {
    if (block.count[s] < min_rest_rows) return false;
    const double rate = rest_noise * noise_[s].rate, force = rest_noise * noise_[s].force;
    if (variance(block.sum[s], block.square[s], block.count[s]) > rate * rate) return false;
    if (variance(block.force_sum[s], block.force_square[s], block.count[s]) > force * force) return false;
  }
  return true;
}

void RestBias::close() {
  open_.is_quiet = is_quiet(open_);
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
    is_rest = std::ranges::all_of(last_, &Block::is_quiet);
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

void RestBias::correct(ChainFilter& filter) const {
  const FilterModel& model = filter.model();
  const Block& middle = last_[1];
  const auto mean = [&](std::size_t s) { return Vec3(middle.sum[s] / middle.count[s]); };
  for (const InsBody& body : model.bodies) {
    if (body.motion != JointMotion::revolute || body.sensor < 0) continue;
    const InsBody& before = model.bodies[static_cast<std::size_t>(body.parent)];
    if (before.sensor < 0) continue;
    const auto p = static_cast<std::size_t>(before.sensor), c = static_cast<std::size_t>(body.sensor);
    if (!filter.uses_sensor(p) || !filter.uses_sensor(c)) continue;
    const Vec3 a = body.parent_R_axis.col(2), b = body.child_R_axis.col(2);
    ChainFilter::ScalarRow row;
    for (Index k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      row.at[i] = model.layout.sensor_state(body.sensor) + SensorIndex::gyroscope_bias + k;
      row.at[i + 3] = model.layout.sensor_state(before.sensor) + SensorIndex::gyroscope_bias + k;
      row.factor[i] = b[k];
      row.factor[i + 3] = -a[k];
    }
    row.terms = 6;
    row.innovation = b.dot(mean(c) - filter.state().sensors[c].gyroscope_bias) -
                     a.dot(mean(p) - filter.state().sensors[p].gyroscope_bias);
    row.variance = noise_[c].rate * noise_[c].rate / middle.count[c] +
                   noise_[p].rate * noise_[p].rate / middle.count[p] + rest_creep * rest_creep;
    filter.update(row);
  }
}

}  // namespace kinfer::track
