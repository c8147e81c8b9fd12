// SPDX-License-Identifier: Apache-2.0
// A moving sensor with known orientation: the ground truth of filters.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "kinfer/base/angle.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"
#include "kinfer/measurement/ins/ins_screening.hpp"
#include "kinfer/measurement/sensor_model.hpp"

namespace kinfer::testing {

struct CarriedMotion {
  double seconds = 40.0, sampling_rate = 200.0;  ///< [s], [Hz]
  double rest = 4.0;                             ///< [s] at either end
  double swing = 1.0;                            ///< [rad] of each of three angles
  double reach = 0.3;                            ///< [m] of each coordinate
  double pace = 1.0;                             ///< 1: periods of 2 to 5 s
  double declination = 0.0;                      ///< [rad] rotation of the field's horizontal part about the vertical
  Quat mounting = Quat::Identity();              ///< sensor to carrier
  const SensorModel* grade = nullptr;            ///< null: without errors
  bool has_magnetometer = true;
  int seed = 1;
};

struct CarriedSensor {
  InsSensor sensor;
  std::vector<double> time;
  std::vector<Quat> truth;  ///< sensor to world
};

inline double envelope(double t, const CarriedMotion& m) {
  const auto step = [](double x) { return x <= 0 ? 0.0 : x >= 1 ? 1.0 : x * x * x * (10 - 15 * x + 6 * x * x); };
  return step((t - m.rest) / 2) * step((m.seconds - m.rest - t) / 2);
}

inline Quat carrier_orientation(double t, const CarriedMotion& m) {
  const double e = m.swing * envelope(t, m), w = 2 * std::numbers::pi * m.pace;
  return Quat(from_rpy(
      {0.1 + e * std::sin(w * t / 2.3), -0.2 + e * std::sin(w * t / 3.1 + 1), 0.4 + 1.5 * e * std::sin(w * t / 4.7)}));
}

inline Vec3 carrier_position(double t, const CarriedMotion& m) {
  const double e = m.reach * envelope(t, m), w = 2 * std::numbers::pi * m.pace;
  return e * Vec3(std::sin(w * t / 2.9), std::sin(w * t / 3.7 + 2), std::sin(w * t / 2.1 + 1));
}

inline void append(TriadColumns& triad, const Vec3& v) {
  for (std::size_t i = 0; i < 3; ++i) triad.axis[i].push_back(static_cast<float>(v[static_cast<Eigen::Index>(i)]));
}

/// A row holds the mean rate since the row before; specific force and field are those of the middle of that interval.
inline CarriedSensor carried(const CarriedMotion& m) {
  CarriedSensor out;
  const double dt = 1.0 / m.sampling_rate, h = 1e-3;
  const SensorModel perfect, &grade = m.grade ? *m.grade : perfect;
  const Rng rng(static_cast<std::uint64_t>(m.seed));
  SimulatedInstrument accelerometer(grade.accelerometer, sample_instrument_errors(grade.accelerometer, rng.stream(1)),
                                    rng.stream(2));
  SimulatedInstrument gyroscope(grade.gyroscope, sample_instrument_errors(grade.gyroscope, rng.stream(3)),
                                rng.stream(4));
  SimulatedInstrument magnetometer(grade.magnetometer, sample_instrument_errors(grade.magnetometer, rng.stream(5)),
                                   rng.stream(6));
  const Vec3 field_world = rot_z(m.declination) * Vec3(0, 20.5, -44);
  const auto pose = [&](double t) { return carrier_orientation(t, m) * m.mounting; };
  for (int k = 0; k < static_cast<int>(m.seconds * m.sampling_rate); ++k) {
    const double t = k * dt, middle = t - 0.5 * dt;
    const Quat now = pose(t), half = pose(middle);
    const Vec3 angular_velocity = quat_log(pose(t - dt).conjugate() * now) / dt;
    const Vec3 acceleration =
        (carrier_position(middle + h, m) - 2 * carrier_position(middle, m) + carrier_position(middle - h, m)) / (h * h);
    append(out.sensor.acceleration, accelerometer.read(half.conjugate() * (acceleration + Vec3(0, 0, 9.80665)), dt));
    append(out.sensor.angular_velocity, gyroscope.read(angular_velocity, dt));
    if (m.has_magnetometer) append(out.sensor.field, magnetometer.read(half.conjugate() * field_world, dt));
    out.time.push_back(t);
    out.truth.push_back(now);
  }
  out.sensor.name = "imu";
  flag_faults(out.sensor);
  return out;
}

}  // namespace kinfer::testing
