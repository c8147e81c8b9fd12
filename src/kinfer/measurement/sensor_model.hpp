// SPDX-License-Identifier: Apache-2.0
// Error models of inertial sensors: noise, bias, scale and cross-axis errors, range and resolution of their
// instruments.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

/// One three-axis instrument, in its own SI unit u (magnetometer: µT). Zeros mean a perfect instrument.
struct InstrumentModel {
  double noise_density = 0.0;  ///< [u/√Hz] white noise as data sheets state it: sd of a row = density · √(rate / 2)
  double bias_sd = 0.0;        ///< [u] of the constant bias of an axis (magnetometer: hard iron)
  double instability = 0.0;    ///< [u] sd of the bias instability, a Gauss-Markov process
  double instability_time = 100.0;  ///< [s] its correlation time
  double scale_sd = 0.0;            ///< of the scale and cross-axis terms (magnetometer: soft iron)
  double range = std::numeric_limits<double>::infinity();  ///< [u] measurements beyond ± this are clipped
  double resolution = 0.0;                                 ///< [u] of one count
};

struct SensorModel {
  std::string name;
  InstrumentModel accelerometer, gyroscope, magnetometer;
};

/// The three grades of docs/development/methods/orientation.md: "noise", "industrial", "consumer"; nullopt for other
/// names.
std::optional<SensorModel> sensor_grade(std::string_view name);
inline constexpr std::array<std::string_view, 3> sensor_grade_names{"noise", "industrial", "consumer"};

/// Systematic errors of one individual instrument: measured = matrix · truth + bias.
struct InstrumentErrors {
  Mat3 matrix = Mat3::Identity();
  Vec3 bias = Vec3::Zero();
};
InstrumentErrors sample_instrument_errors(const InstrumentModel& model, Rng rng);

/// Simulates one individual instrument: systematic errors, bias instability, noise, range, resolution. Stateful: each
/// call advances the bias and draws new noise.
class SimulatedInstrument {
 public:
  SimulatedInstrument(const InstrumentModel& model, const InstrumentErrors& errors, Rng rng);

  /// Measurement of the truth [u], `dt` seconds after the previous one; the noise bandwidth is half the sampling rate.
  Vec3 read(const Vec3& truth, double dt);

 private:
  Vec3 draw_normals();
  InstrumentModel model_;
  InstrumentErrors errors_;
  Rng rng_;
  Vec3 bias_instability_ = Vec3::Zero();
};

}  // namespace kinfer
