// What an inertial sensor is worth: noise, bias, scale and cross-axis errors, range and resolution of its instruments.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

/// One instrument of three axes, in its own SI unit u (magnetometer: µT). Zeros mean a perfect instrument.
struct InstrumentModel {
  double noise_density = 0.0;  ///< [u/√Hz] white noise as data sheets state it: sd of a row = density · √(rate / 2)
  double bias_sd = 0.0;        ///< [u] of the constant bias of an axis (magnetometer: hard iron)
  double instability = 0.0;    ///< [u] sd of the bias that wanders, a Gauss-Markov process
  double instability_time = 100.0;  ///< [s] its correlation time
  double scale_sd = 0.0;            ///< of the scale and cross-axis terms (magnetometer: soft iron)
  double range = std::numeric_limits<double>::infinity();  ///< [u] readings beyond ± this are clipped
  double resolution = 0.0;                                 ///< [u] of one count
};

struct SensorModel {
  std::string name;
  InstrumentModel accelerometer, gyroscope, magnetometer;
};

/// The three grades of docs/methods/orientation.md: "noise", "industrial", "consumer"; nothing for another name.
std::optional<SensorModel> sensor_grade(std::string_view name);
inline constexpr std::array<std::string_view, 3> sensor_grade_names{"noise", "industrial", "consumer"};

/// The systematic errors of one individual instrument: reading = matrix · truth + bias.
struct InstrumentErrors {
  Mat3 matrix = Mat3::Identity();
  Vec3 bias = Vec3::Zero();
};
InstrumentErrors drawn_errors(const InstrumentModel& model, Rng rng);

/// One individual instrument that reads: errors, wandering bias, noise, range, resolution. Streams; a row that is read
/// twice reads differently.
class SimulatedInstrument {
 public:
  SimulatedInstrument(const InstrumentModel& model, const InstrumentErrors& errors, Rng rng);

  /// Reading of the truth [u] after `dt` seconds; its noise has the bandwidth of half the sampling rate.
  Vec3 read(const Vec3& truth, double dt);

 private:
  Vec3 normals();
  InstrumentModel model_;
  InstrumentErrors errors_;
  Rng rng_;
  Vec3 wander_ = Vec3::Zero();
};

}  // namespace kinfer
