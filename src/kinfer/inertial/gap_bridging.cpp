// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/gap_bridging.hpp"

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

void interpolate(TriadColumns& triad, std::span<const double> time, std::size_t from, std::size_t to) {
  for (std::size_t row = from + 1; row < to; ++row) {
    const double share = (time[row] - time[from]) / (time[to] - time[from]);
    for (auto& column : triad.axis)
      column[row] = static_cast<float>((1.0 - share) * static_cast<double>(column[from]) +
                                       share * static_cast<double>(column[to]));
  }
}

/// `bad`: the fault bits that make a measurement of the triad unusable.
void bridge(TriadColumns& triad, std::vector<std::uint8_t>& faults, std::span<const double> time, unsigned unusable,
            double longest) {
  if (!triad.present()) return;
  std::size_t last_sound = faults.size();
  for (std::size_t row = 0; row < faults.size(); ++row) {
    if (faults[row] & unusable) continue;
    if (last_sound + 1 < row && time[row] - time[last_sound] <= longest) {
      interpolate(triad, time, last_sound, row);
      for (std::size_t i = last_sound + 1; i < row; ++i) faults[i] = static_cast<std::uint8_t>(faults[i] & ~unusable);
    }
    last_sound = row;
  }
}

}  // namespace

InsSensor bridge_gaps(const InsSensor& sensor, std::span<const double> time, double longest) {
  KINFER_EXPECT(time.size() == sensor.rows());
  InsSensor whole = sensor;
  bridge(whole.angular_velocity, whole.faults, time, angular_velocity_missing | angular_velocity_spike, longest);
  bridge(whole.acceleration, whole.faults, time, acceleration_missing | acceleration_clipped | acceleration_spike,
         longest);
  return whole;
}

}  // namespace kinfer
