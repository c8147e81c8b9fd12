// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/faults/mount_watch.hpp"

#include "kinfer/track/faults/thresholds.hpp"

namespace kinfer::track {

void MountWatch::begin(std::size_t sensor, const ChainFilter& before, std::span<const BlockMeasurement> rows,
                       double log_odds) {
  mounts_[sensor].emplace(before, rows, sensor, log_odds);
}

void MountWatch::add(const BlockMeasurement& block, const ChainFilter& filter,
                     const std::function<bool(std::size_t)>& is_watched) {
  for (std::size_t s = 0; s < mounts_.size(); ++s) {
    if (!is_watched(s))
      mounts_[s].reset();
    else if (!mounts_[s])
      mounts_[s].emplace(filter, s);
    else if (mounts_[s]->time() < block.time)
      mounts_[s]->add(block, filter);
  }
}

void MountWatch::reset() {
  for (std::optional<TurnedMount>& mount : mounts_) mount.reset();
}

void MountWatch::correct(const std::function<void(ChainFilter&)>& correction) {
  for (std::optional<TurnedMount>& mount : mounts_)
    if (mount) correction(mount->filter());
}

std::optional<double> MountWatch::log_odds_of_original(std::size_t sensor) const {
  return mounts_[sensor] ? mounts_[sensor]->log_odds_of_original() : std::nullopt;
}

bool MountWatch::may_return(std::size_t sensor) const {
  const std::optional<double> odds = log_odds_of_original(sensor);
  return !odds || *odds > mount_log_odds;
}

bool MountWatch::is_turned(std::size_t sensor) const {
  const std::optional<double> odds = log_odds_of_original(sensor);
  return odds && *odds < -mount_log_odds;
}

}  // namespace kinfer::track
