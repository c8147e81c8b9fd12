// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/tracking/track_state.hpp"

#include <array>

namespace kinfer {

std::string_view name(JointSource source) {
  constexpr std::array<std::string_view, 3> names{"none", "chain", "composed"};
  return names[static_cast<std::size_t>(source)];
}

std::string_view name(JointReference reference) {
  constexpr std::array<std::string_view, 2> names{"chain", "start"};
  return names[static_cast<std::size_t>(reference)];
}

std::string_view name(TrackAlarmKind kind) {
  constexpr std::array<std::string_view, 10> names{"does_not_fit", "sensor_moved",    "joint_changed", "sensor_lost",
                                                   "sensor_stuck", "sensor_clipped",  "sensor_late",   "restarted",
                                                   "start_wrong",  "sensor_exchanged"};
  return names[static_cast<std::size_t>(kind)];
}

}  // namespace kinfer
