// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/recording_selection.hpp"

#include <numeric>

namespace kinfer::identify {

RecordingSelection select_all(std::size_t sensors) {
  RecordingSelection all;
  all.sensors.resize(sensors);
  std::iota(all.sensors.begin(), all.sensors.end(), std::size_t{0});
  return all;
}

}  // namespace kinfer::identify
