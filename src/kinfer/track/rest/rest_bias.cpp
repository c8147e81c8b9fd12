// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/rest/rest_bias.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/square.hpp"
#include "kinfer/track/model/thresholds.hpp"

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

bool RestBias::is_upright(const InsBody& joint, std::size_t parent_sensor) const {
  const Vec3 up = last_[1].force_sum[parent_sensor].normalized();
  return joint.parent_R_axis.col(2).cross(up).norm() < upright_axis;
}

/// Whether this joint, and no other one of its sensors, integrates their noise to a position that gravity does not
/// hold.
bool RestBias::integrates_alone(const FilterModel& model, std::size_t body) const {
  const int parent_body = model.bodies[body].parent;
  const auto is_upright_joint = [&](const InsBody& other) {
    if (other.motion != JointMotion::revolute || other.parent < 0) return false;
    const int sensor = model.bodies[static_cast<std::size_t>(other.parent)].sensor;
    return sensor >= 0 && rests(static_cast<std::size_t>(sensor)) &&
           is_upright(other, static_cast<std::size_t>(sensor));
  };
  if (!is_upright_joint(model.bodies[body])) return false;
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const InsBody& other = model.bodies[b];
    const bool shares =
        other.parent == parent_body || other.parent == static_cast<int>(body) || static_cast<int>(b) == parent_body;
    if (b != body && shares && is_upright_joint(other)) return false;
  }
  return true;
}

/// Difference of the biases of a joint's sensors along its axis; that of the child alone where the parent is a base
/// that stands still, whose own gyroscope says nothing of the child's. About an upright axis the noise that remains in
/// it has been integrated to the joint's position, and nothing else has corrected it since.
ChainFilter::ScalarRow RestBias::bias_row(const ChainFilter& filter, std::size_t body) const {
  const FilterModel& model = filter.model();
  const InsBody& joint = model.bodies[body];
  ChainFilter::ScalarRow row;
  row.variance = square(rest_creep);
  double integrated = 0.0;  // variance of what has been integrated to the position
  const auto add = [&](int sensor, const Vec3& axis) {
    const auto s = static_cast<std::size_t>(sensor);
    for (Index k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(row.terms++);
      row.at[i] = model.layout.sensor_state(sensor) + SensorIndex::gyroscope_bias + k;
      row.factor[i] = axis[k];
    }
    row.innovation += axis.dot(mean_rate(s) - filter.state().sensors[s].gyroscope_bias);
    const double of_mean = square(noise_[s].rate) / last_[1].count[s];
    row.variance += of_mean;
    integrated += of_mean;
  };
  add(joint.sensor, joint.child_R_axis.col(2));
  const bool is_on_still_base = joint.parent == 0 && filter.state().base == BaseMode::still;
  if (!is_on_still_base) add(model.bodies[static_cast<std::size_t>(joint.parent)].sensor, -joint.parent_R_axis.col(2));
  if (last_[1].begin >= filter.placed_at() && integrates_alone(model, body)) {
    row.noisy_state = model.layout.joint_state(model.layout.position[body]);
    row.noise_covariance = -rest_block * integrated;
  }
  return row;
}

void RestBias::correct(ChainFilter& filter) const {
  const FilterModel& model = filter.model();
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const InsBody& body = model.bodies[b];
    if (body.motion != JointMotion::revolute || body.sensor < 0) continue;
    const int parent = model.bodies[static_cast<std::size_t>(body.parent)].sensor;
    if (parent < 0) continue;
    const auto p = static_cast<std::size_t>(parent), c = static_cast<std::size_t>(body.sensor);
    if (!filter.uses_sensor(p) || !filter.uses_sensor(c) || !rests(p) || !rests(c)) continue;
    const ChainFilter::ScalarRow row = bias_row(filter, b);
    if (is_rest(row.innovation, filter.variance(row))) filter.update(row);
  }
}

}  // namespace kinfer::track
