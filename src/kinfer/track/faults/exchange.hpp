// SPDX-License-Identifier: Apache-2.0
// Whether two sensors measure in each other's place: cables, names or mountings that were changed over. Block by block
// each of the two is named as moved, one after the other, and what was stated before is wrong from the start.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "kinfer/track/start/initial_posture.hpp"

namespace kinfer::track {

struct Exchange {
  std::size_t first = 0, second = 0;  ///< sensors
  double since = 0.0;                 ///< [s] of the last row that showed it
};

/// Two sensors that make `rows` likelier in each other's place than as they are, and with which the chain explains all
/// sensors. A filter starts anew in either case, since the posture before was wrong.
std::optional<Exchange> find_exchange(const std::shared_ptr<const FilterModel>& model,
                                      std::span<const BlockMeasurement> rows, const std::vector<PositionGuess>& guesses,
                                      BaseMode base);

/// Keeps the last rows, and looks for an exchange in them a while after a sensor was named. It is one where two trials
/// in a row find the same: in seconds in which another fault shows an exchange may be likelier by chance. Copyable.
class ExchangeWatch {
 public:
  explicit ExchangeWatch(std::shared_ptr<const FilterModel> model);

  /// Whether sensors, or the chain as a whole, do not fit.
  void suspect(bool is_suspected);
  /// Nothing is allocated but for a trial.
  void add(const BlockMeasurement& block, const std::vector<PositionGuess>& guesses, BaseMode base);
  const std::optional<Exchange>& found() const { return found_; }

 private:
  std::shared_ptr<const FilterModel> model_;
  std::vector<BlockMeasurement> recent_;  // a ring
  std::size_t next_ = 0, since_trial_ = 0;
  int trials_ = 0;  // left
  bool is_suspected_ = false;
  std::optional<Exchange> likely_{}, found_{};  // by one trial, by two in a row
};

}  // namespace kinfer::track
