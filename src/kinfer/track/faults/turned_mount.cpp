// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/faults/turned_mount.hpp"

#include "kinfer/base/square.hpp"
#include "kinfer/track/faults/sensor_return.hpp"
#include "kinfer/track/faults/thresholds.hpp"

namespace kinfer::track {
namespace {

ChainFilter with_sensor(ChainFilter filter, std::size_t sensor) {
  filter.use_sensor(sensor, true);
  return filter;
}

MountTurn loosened(MountTurn turn) {
  turn.covariance.diagonal().array() += square(turned_mount_sd);
  return turn;
}

}  // namespace

/// The turn happened at some time in these rows: until they end it is a random walk.
TurnedMount::TurnedMount(const ChainFilter& before, std::span<const BlockMeasurement> rows, std::size_t sensor,
                         double log_odds)
    : sensor_(sensor),
      original_(mount_turn(before, sensor)),
      supposed_(loosened(original_)),
      filter_(with_sensor(before, sensor)),
      fit_(before.model().sensors.size(), before.model().joints.size()),
      log_odds_(log_odds) {
  for (const BlockMeasurement& block : rows) {
    loosen_mount(filter_, sensor_, square(turned_mount_sd) / static_cast<double>(rows.size()));
    update(block);
  }
  fit_.reset();
}

TurnedMount::TurnedMount(const ChainFilter& without, std::size_t sensor) : TurnedMount(without, {}, sensor, 0.0) {
  begin(without);
}

/// What its samples have shown until now is given up: they may have been anything while the mounting changed. A turn
/// cannot be told from a position that is lost.
void TurnedMount::begin(const ChainFilter& without) {
  filter_ = without;
  filter_.use_sensor(sensor_, true);
  is_known_ = !has_lost_position(filter_, sensor_);
  log_odds_ = 0.0;
  supposed_ = loosened(mount_turn(filter_, sensor_));
  loosen_mount(filter_, sensor_, square(turned_mount_sd));
  fit_.reset();
}

void TurnedMount::update(const BlockMeasurement& block) {
  filter_.predict(block.time);
  filter_.update(block);
  fit_.add(filter_, block.time, block.length);
}

void TurnedMount::add(const BlockMeasurement& block, const ChainFilter& without) {
  if (!is_known_) return;
  filter_.judge_as(without);
  filter_.use_sensor(sensor_, true);
  update(block);
  if (fit_.sensor(sensor_).is_suspect) begin(without);
}

std::optional<double> TurnedMount::log_odds_of_original() const {
  if (!is_known_) return {};
  return log_odds_of(original_, supposed_, mount_turn(filter_, sensor_)) - log_odds_;
}

}  // namespace kinfer::track
