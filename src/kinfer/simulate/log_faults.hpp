// What goes wrong with real logs, done to simulated ones on purpose.
#pragma once

#include "kinfer/geometry/pose.hpp"
#include "kinfer/measurement/ins_recording.hpp"
#include "kinfer/simulate/machine_motion.hpp"

namespace kinfer {

/// A sensor whose clock is not the others': what happens at t it logs at t + offset + drift (t − middle).
struct ClockFault {
  std::size_t sensor = 0;
  double offset = 0.0;  ///< [s] at the middle of the recording; positive: logged late
  double drift = 0.0;   ///< [s/s]
};

/// The sensor as the only one of a logger that has such a clock.
InsRecording with_own_clock(const InsRecording& recording, const ClockFault& fault);

/// The sensor in the same rows as the others, its readings that many rows late; the first ones are missing.
InsRecording with_late_rows(const InsRecording& recording, std::size_t sensor, std::size_t rows);

/// A sensor that is taken to another place and turn of its segment from row `row` on; old_T_new of its frame.
MachineMotion with_remount(MachineMotion motion, std::size_t sensor, std::size_t row, const Pose& old_T_new);

/// Two recordings of the same rate in one, rows beside rows; the other's sensors get `prefix` before their names.
InsRecording side_by_side(const InsRecording& one, const InsRecording& other, const std::string& prefix);

}  // namespace kinfer
