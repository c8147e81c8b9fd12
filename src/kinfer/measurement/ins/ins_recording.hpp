// SPDX-License-Identifier: Apache-2.0
// Recordings of inertial sensors: columns of specific force, angular velocity and magnetic field, sampled on the clock
// of their logger, with flags on samples that must not be used. Gaps and faults are flagged and counted, never filled
// in.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

/// Three columns x, y, z with one value per row; NaN where the file has none, empty where the sensor lacks the
/// instrument. `float` because an hour of six sensors at 200 Hz then takes 160 MB instead of 310 MB, and its 24 bits
/// are far finer than the noise of any such sensor.
struct TriadColumns {
  std::array<std::vector<float>, 3> axis;

  bool present() const { return !axis[0].empty(); }
  Vec3 at(std::size_t row) const { return {axis[0][row], axis[1][row], axis[2][row]}; }
};

/// Why a sample is not used; a bit mask, because a row may have several faults.
enum Fault : std::uint8_t {
  acceleration_missing = 1,
  angular_velocity_missing = 2,
  field_missing = 4,
  acceleration_clipped = 8,
  angular_velocity_clipped = 16,
  acceleration_spike = 32,
  angular_velocity_spike = 64,
};

/// One INS; its right-handed frame is that of the housing.
struct InsSensor {
  std::string name;
  std::size_t logger = 0;            ///< index into InsRecording::loggers: its clock and rows
  TriadColumns acceleration;         ///< [m/s²] specific force: +g upward at rest
  TriadColumns angular_velocity;     ///< [rad/s]
  TriadColumns field;                ///< [µT], or arbitrary units
  std::vector<std::uint8_t> faults;  ///< bit masks of Fault, one per row

  std::size_t rows() const { return faults.size(); }
  bool has_magnetometer() const { return field.present(); }
};

/// The rows of one file, or of those of its sensors that were sampled at the same instants.
struct InsLogger {
  std::string name;          ///< the file's base name
  std::vector<double> time;  ///< [s], strictly increasing, one per row
  int shared_clock = -1;  ///< loggers with the same number ≥ 0 were stamped by one clock; −1: by a clock of its own
  bool states_unit = false;  ///< the file says in which unit its times are, which is believed
};

struct InsRecording {
  std::vector<InsLogger> loggers;
  std::vector<InsSensor> sensors;
  std::vector<std::string> remarks;  ///< of the file reader, for the user, one sentence each

  std::span<const double> time(const InsSensor& sensor) const { return loggers[sensor.logger].time; }
};

/// Whether the rows of two loggers, indices into InsRecording::loggers, were stamped by one clock.
bool share_clock(const InsRecording& recording, std::size_t one, std::size_t other);

/// Number of rows with this fault.
std::size_t count(const InsSensor& sensor, Fault fault);

/// One row of one sensor: the input of a filter.
struct InsSample {
  double time = 0.0;                     ///< [s]
  Vec3 acceleration = Vec3::Zero();      ///< [m/s²], where has_acceleration
  Vec3 angular_velocity = Vec3::Zero();  ///< [rad/s], where has_angular_velocity
  Vec3 field = Vec3::Zero();             ///< where has_field
  bool has_acceleration = false, has_angular_velocity = false, has_field = false;
  bool angular_velocity_clipped = false;  ///< has_angular_velocity, but saturated: the true rate was larger
};
InsSample sample(const InsSensor& sensor, std::span<const double> time, std::size_t row);

/// [s] between samples of a sensor that can follow a machine: no INS samples at 100 kHz, no motion is seen at 2 Hz, and
/// a log of 1 kHz in milliseconds reads 1.
inline constexpr double shortest_sample_period = 1e-5, longest_sample_period = 0.5;

/// Median time between rows [s]; 0 if there are fewer than two rows.
double median_period(std::span<const double> time);

/// The same between samples: where most rows are closer than samples can be, because several are stamped at once, the
/// mean step without gaps. Packets of 100 rows and more are not seen through.
double sample_period(std::span<const double> time);

/// A time step longer than this multiple of the typical period is a gap.
constexpr double gap_factor = 3.5;

struct TimeGap {
  std::size_t row = 0;            ///< first row after the gap
  double begin = 0.0, end = 0.0;  ///< [s]
};
std::vector<TimeGap> gaps(std::span<const double> time);

}  // namespace kinfer
