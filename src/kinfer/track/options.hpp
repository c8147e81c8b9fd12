// SPDX-License-Identifier: Apache-2.0
// Input of a tracker: rows of samples, and what the user knows.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/linalg/types.hpp"
#include "kinfer/measurement/ins_recording.hpp"

namespace kinfer::track {

/// The samples of one instant, one for each sensor of the model in its order; a sensor without a sample has no has_*.
struct InsRow {
  double time = 0.0;  ///< [s] never decreases
  std::vector<InsSample> sensors;
};

enum class BaseMotion { automatic, still, moving };

struct TrackOptions {
  BaseMotion base = BaseMotion::automatic;
  /// [rad] or [m], one per joint position; NaN: unknown. Where the machine is when tracking begins.
  std::optional<VectorXd> start{};
};

}  // namespace kinfer::track
