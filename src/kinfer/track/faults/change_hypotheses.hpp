// SPDX-License-Identifier: Apache-2.0
// What changed, a sensor or a joint, by the likelihood of some seconds of rows as a whole. Block by block a change of a
// joint has as many unknowns as one of a sensor beside it, and explains it as well; but a turn of a mounting is the
// same in all blocks. So a filter with an unknown turn of the sensor's mounting runs through the rows, one that doubts
// the joint, and one to which nothing has happened.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "kinfer/track/faults/fit_monitor.hpp"

namespace kinfer::track {

/// The sensor next to the joint whose turn within `rows` makes them likelier than a change of the joint. `before`: the
/// filter before them.
std::optional<std::size_t> turned_beside(const ChainFilter& before, std::span<const BlockMeasurement> rows,
                                         std::size_t joint);

/// A change that showed at once.
struct SuddenChange {
  double from = 0.0, until = 0.0;                    ///< [s] within which it happened
  std::function<bool(std::size_t)> may_have_turned;  ///< of sensors
};

struct LikelyCause {
  Suspect suspect{};
  double log_odds = 0.0;  ///< against no change
};

/// The sensor that turned at once, or the joint beside it that changed, whichever makes `rows` likeliest. `before`: the
/// filter before them.
LikelyCause likeliest_cause(const ChainFilter& before, std::span<const BlockMeasurement> rows,
                            const SuddenChange& change);

}  // namespace kinfer::track
