// What inertial sensors said: columns of specific force, angular rate and magnetic field, row by row of their logger's
// clock, with marks where a number must not be used. Gaps and faults are marked and counted, never filled in.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

/// Three columns x, y, z, one number a row; NaN where none was written, no columns at all where the sensor has no such
/// instrument. `float` because an hour of six sensors at 200 Hz then takes 160 MB instead of 310 MB, and its 24 bits
/// are far finer than any such sensor's noise.
struct TriadColumns {
  std::array<std::vector<float>, 3> axis;

  bool present() const { return !axis[0].empty(); }
  Vec3 at(std::size_t row) const { return {axis[0][row], axis[1][row], axis[2][row]}; }
};

/// Why a number of a row is not used; bits, because a row may have several.
enum Fault : std::uint8_t {
  acceleration_missing = 1,
  rate_missing = 2,
  field_missing = 4,
  acceleration_clipped = 8,
  rate_clipped = 16,
  acceleration_spike = 32,
  rate_spike = 64,
};

/// One INS: sensor coordinates x, y, z are those of its housing, right-handed.
struct InsSensor {
  std::string name;
  std::size_t logger = 0;            ///< whose clock and rows
  TriadColumns acceleration;         ///< [m/s²] specific force: +g upward at rest
  TriadColumns rate;                 ///< [rad/s]
  TriadColumns field;                ///< [µT], or arbitrary units
  std::vector<std::uint8_t> faults;  ///< bits of Fault, one a row

  std::size_t rows() const { return faults.size(); }
  bool has_magnetometer() const { return field.present(); }
};

/// One clock: the rows of one file.
struct InsLogger {
  std::string name;          ///< the file's base name
  std::vector<double> time;  ///< [s], strictly increasing, one a row
};

struct InsRecording {
  std::vector<InsLogger> loggers;
  std::vector<InsSensor> sensors;
  std::vector<std::string> remarks;  ///< what the reader saw and a user should know, a sentence each

  std::span<const double> time(const InsSensor& sensor) const { return loggers[sensor.logger].time; }
};

/// Number of rows that carry the fault.
std::size_t count(const InsSensor& sensor, Fault fault);

/// What a filter takes: one row of one sensor.
struct InsSample {
  double time = 0.0;                 ///< [s]
  Vec3 acceleration = Vec3::Zero();  ///< [m/s²], where has_acceleration
  Vec3 rate = Vec3::Zero();          ///< [rad/s], where has_rate
  Vec3 field = Vec3::Zero();         ///< where has_field
  bool has_acceleration = false, has_rate = false, has_field = false;
  bool rate_clipped = false;  ///< has_rate, but the true rate was larger
};
InsSample sample(const InsSensor& sensor, std::span<const double> time, std::size_t row);

/// Seconds between rows as most rows have it (median); 0 where there are fewer than two rows.
double typical_period(std::span<const double> time);

/// Rows that lie more than this factor of the typical period after the row before begin a new stretch.
constexpr double gap_factor = 3.5;

struct TimeGap {
  std::size_t row = 0;            ///< first row after the gap
  double begin = 0.0, end = 0.0;  ///< [s]
};
std::vector<TimeGap> gaps(std::span<const double> time);

}  // namespace kinfer
