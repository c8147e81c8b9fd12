// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/faults/sensor_return.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/square.hpp"
#include "kinfer/track/faults/thresholds.hpp"

namespace kinfer::track {
namespace {

double position_sd(const ChainFilter& filter, Index position) {
  const Index at = filter.model().layout.joint_state(position);
  return std::sqrt(filter.covariance()(at, at));
}

double position_of(const ChainFilter& filter, Index position) {
  return filter.state().joints[position_states * position];
}

double circular_distance(double a, double b) {
  return std::abs(wrap_to_pi(a - b));
}

/// Whether the sensor shows a position that is lost: that of its own joint, or of one to a sensor that is in use.
bool shows_lost_position(const ChainFilter& filter, std::size_t sensor, const RevoluteBetweenSensors& joint) {
  const bool is_shown =
      joint.child_sensor == sensor || (joint.parent_sensor == sensor && filter.uses_sensor(joint.child_sensor));
  return is_shown && position_sd(filter, joint.position) > turned_in_gap;
}

using Joints = std::vector<RevoluteBetweenSensors>;

/// From the base outward.
Joints lost_joints(const ChainFilter& filter, std::size_t sensor) {
  Joints lost;
  for (const RevoluteBetweenSensors& joint : filter.model().revolute)
    if (shows_lost_position(filter, sensor, joint)) lost.push_back(joint);
  return lost;
}

/// Unseen velocities may be so far off that specific forces, quadratic in them, say nothing; gyroscopes show them.
void suppose_velocities(ChainFilter& filter, const BlockMeasurement& first, const Joints& joints) {
  for (const RevoluteBetweenSensors& joint : joints)
    if (const BlockSample& child = first.sensors[joint.child_sensor]; child.rate_count > 0)
      filter.suppose_velocity(joint.position, joint.child_sensor, child.rate);
}

/// Of a position before the rows, where the rows place it.
struct Place {
  double value = 0.0;           // [rad]
  double log_likelihood = 0.0;  // of the rows, and of the place by what was known before
  double sd = 0.0;              // [rad] after the rows
};

/// Begins again and again where the rows place the position, as uncertain as at first.
Place settled_place(const ChainFilter& before, std::span<const BlockMeasurement> rows, const Joints& lost,
                    Index position, double value, double sd) {
  const double expected = position_of(before, position), expected_sd = position_sd(before, position);
  Place place{.value = value};
  for (int round = 0; round < return_rounds; ++round) {
    ChainFilter trial = before;
    trial.suppose(position, place.value, sd);
    suppose_velocities(trial, rows.front(), lost);
    place.log_likelihood = -0.5 * square((place.value - expected) / expected_sd);
    double turned = 0.0, last_time = before.state().time;
    std::optional<double> last_rate;  // [rad/s] the gyroscopes show it from the first block
    for (const BlockMeasurement& block : rows) {
      trial.predict(block.time);
      trial.update(block);
      place.log_likelihood += trial.innovations().log_likelihood;
      const double rate = trial.state().joints[position_states * position + 1];
      turned += (block.time - last_time) * 0.5 * (last_rate.value_or(rate) + rate);
      last_rate = rate, last_time = block.time;
    }
    place.sd = position_sd(trial, position);
    if (round + 1 < return_rounds) place.value = position_of(trial, position) - turned;
  }
  return place;
}

/// The likeliest place on the circle, and by how much it is likelier than any other.
struct Search {
  Place best{};
  double log_odds = std::numeric_limits<double>::infinity();
};

Search search(const ChainFilter& before, std::span<const BlockMeasurement> rows, const Joints& lost, Index position) {
  const double step = 2.0 * std::numbers::pi / return_places, expected = position_of(before, position),
               expected_sd = position_sd(before, position);
  std::vector<Place> places;
  for (int k = 0; k < return_places; ++k) {
    const double turn = wrap_to_pi(k * step);
    if (std::abs(turn) > 0.5 * step + return_reach * expected_sd) continue;
    places.push_back(settled_place(before, rows, lost, position, expected + turn, std::min(expected_sd, 0.5 * step)));
  }
  Search result{.best = *std::ranges::max_element(places, {}, &Place::log_likelihood)};
  for (const Place& other : places)
    if (circular_distance(other.value, result.best.value) > turned_in_gap)
      result.log_odds = std::min(result.log_odds, result.best.log_likelihood - other.log_likelihood);
  // What is already known of a turn is not given up for a whole one.
  result.best.value = expected + wrap_to_pi(result.best.value - expected);
  return result;
}

}  // namespace

bool has_lost_position(const ChainFilter& filter, std::size_t sensor) {
  return !lost_joints(filter, sensor).empty();
}

FoundAgain find_again(const ChainFilter& before, std::span<const BlockMeasurement> rows, std::size_t sensor) {
  FoundAgain found{.filter = before};
  found.filter.use_sensor(sensor, true);
  const Joints lost = lost_joints(found.filter, sensor);
  for (const RevoluteBetweenSensors& joint : lost) {
    const Search result = search(found.filter, rows, lost, joint.position);
    const bool is_known = result.best.sd < turned_in_gap;
    found.positions.push_back({joint.position, result.best.sd, is_known && result.log_odds > return_log_odds});
    // Less certain than it is by far, since the rows are processed once more.
    if (is_known) found.filter.suppose(joint.position, result.best.value, 0.5 * turned_in_gap);
  }
  suppose_velocities(found.filter, rows.front(), lost);
  for (const BlockMeasurement& block : rows) {
    found.filter.predict(block.time);
    found.filter.update(block);
  }
  return found;
}

bool SensorReturn::waits_for(std::size_t sensor) const {
  return std::ranges::find(sensors_, sensor) != sensors_.end();
}

void SensorReturn::begin(std::size_t sensor, const ChainFilter& filter) {
  sensors_.push_back(sensor);
  std::ranges::sort(sensors_);
  begin_again(filter);
}

void SensorReturn::drop(std::size_t sensor, const ChainFilter& filter) {
  if (std::erase(sensors_, sensor) > 0) begin_again(filter);
}

void SensorReturn::begin_again(const ChainFilter& filter) {
  rows_.clear();
  tried_ = 0.0;
  if (sensors_.empty())
    before_.reset();
  else
    before_ = filter;
}

void SensorReturn::reset() {
  sensors_.clear();
  before_.reset();
  rows_.clear();
}

std::optional<FoundAgain> SensorReturn::add(const BlockMeasurement& block) {
  if (sensors_.empty() || block.time <= before_->state().time) return {};
  rows_.push_back(block);
  const double watched = block.time - before_->state().time;
  if (watched < tried_ + return_length) return {};
  tried_ = watched;
  FoundAgain found = find_again(*before_, rows_, sensors_.front());
  if (!std::ranges::all_of(found.positions, &FoundPosition::is_decided) && watched < return_patience) return {};
  sensors_.erase(sensors_.begin());
  return found;
}

}  // namespace kinfer::track
