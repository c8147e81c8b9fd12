// SPDX-License-Identifier: Apache-2.0
// The part of a recording that is used: sensors and time span.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "kinfer/evidence/facts/findings.hpp"

namespace kinfer::identify {

struct RecordingSelection {
  std::vector<std::size_t> sensors;  ///< by index
  /// [s] on the common clock
  double begin = -std::numeric_limits<double>::infinity(), end = std::numeric_limits<double>::infinity();
  std::vector<Finding> findings;  ///< about what is left out
};

/// All of `sensors` sensors, over the whole recording.
RecordingSelection select_all(std::size_t sensors);

}  // namespace kinfer::identify
