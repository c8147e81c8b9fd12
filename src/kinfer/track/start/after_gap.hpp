// SPDX-License-Identifier: Apache-2.0
// Where a joint is after a gap in the rows, by where it was, by its rates before and after, and by what it can do.
#pragma once

namespace kinfer::track {

/// A position as it was last known, and what the joint has shown.
struct LastPosition {
  double time = 0.0;                         ///< [s]
  double value = 0.0, rate = 0.0, sd = 0.0;  ///< [rad], [rad/s], [rad]
  double most_turned = 0.0;                  ///< [rad] half of its range
  double speed = 0.0;                        ///< [rad/s] its largest
  double acceleration_sd = 0.0;              ///< [rad/s²]
};

struct PositionAfterGap {
  double value = 0.0, sd = 0.0;  ///< [rad]
};

/// Turned at the mean of both rates, which is the rate between but for a twelfth of the change of acceleration. Its
/// standard deviation adds to that before what this leaves, or, if that is less, what the joint can turn at all.
/// `rate`: [rad/s] at `time` [s].
PositionAfterGap after_gap(const LastPosition& last, double time, double rate);

}  // namespace kinfer::track
