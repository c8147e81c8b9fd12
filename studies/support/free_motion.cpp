// SPDX-License-Identifier: Apache-2.0
#include "studies/support/free_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kinfer/base/constants.hpp"
#include "kinfer/measurement/ins/ins_screening.hpp"
#include "kinfer/measurement/sensor_model.hpp"
#include "kinfer/simulate/machine_motion.hpp"

namespace kinfer::study {
namespace {

constexpr double rest = 4.0;  // [s]
constexpr double full_turn = 2.0 * std::numbers::pi;

struct FreeWave {
  double amplitude = 0.0, frequency = 1.0, phase = 0.0;
};
using Waves = std::vector<FreeWave>;

double value_of(const Waves& waves, double time) {
  double sum = 0.0;
  for (const FreeWave& w : waves) sum += w.amplitude * std::sin(full_turn * w.frequency * time + w.phase);
  return sum;
}

/// 0 during the rest, then rising to 1 within two seconds.
double departure(double time) {
  const double x = std::clamp((time - rest) / 2.0, 0.0, 1.0);
  return x * x * x * (10.0 - 15.0 * x + 6.0 * x * x);
}

Waves random_waves(double size, Rng& rng) {
  Waves waves;
  for (int i = 0; i < 4; ++i) {
    const double frequency = rng.uniform(0.2, 1.5), phase = rng.uniform(0.0, full_turn);
    waves.push_back({size / (1.0 + frequency), frequency, phase});
  }
  return waves;
}

/// Two harmonics of a pace.
Waves gait_waves(double size, double pace, Rng& rng) {
  Waves waves;
  for (const double harmonic : {1.0, 2.0}) {
    const double phase = rng.uniform(0.0, full_turn), part = rng.uniform(0.3, 1.0);
    waves.push_back({part * size / harmonic, harmonic * pace, phase});
  }
  return waves;
}

struct SixWaves {
  std::array<Waves, 3> turn, place;

  Pose at(double time) const {
    const double share = departure(time);
    const Vec3 angles(value_of(turn[0], time), value_of(turn[1], time), value_of(turn[2], time)),
        position(value_of(place[0], time), value_of(place[1], time), value_of(place[2], time));
    return {exp_so3(share * angles), share * position};
  }
};

template <class Make>
SixWaves six_waves(double turn, double place, const Make& make) {
  SixWaves waves;
  for (Waves& w : waves.turn) w = make(turn);
  for (Waves& w : waves.place) w = make(place);
  return waves;
}

Mat3 random_rotation(Rng& rng) {
  const double a = rng.normal(), b = rng.normal(), c = rng.normal(), d = rng.normal();
  return Quat(a, b, c, d).normalized().toRotationMatrix();
}

Vec3 random_offset(double size, Rng& rng) {
  const double x = rng.uniform(-size, size), y = rng.uniform(-size, size), z = rng.uniform(-size, size);
  return {x, y, z};
}

void push_sample(TriadColumns& triad, const Vec3& v) {
  for (std::size_t i = 0; i < 3; ++i) triad.axis[i].push_back(static_cast<float>(v[static_cast<Eigen::Index>(i)]));
}

InsSensor record_free_sensor(const FreeSensor& body, const std::vector<double>& time, const SensorModel& grade,
                             const Rng& rng) {
  constexpr double h = 1e-3;  // [s] of the differences
  InsSensor sensor;
  sensor.name = body.name;
  SimulatedInstrument accelerometer(grade.accelerometer, sample_instrument_errors(grade.accelerometer, rng.stream(1)),
                                    rng.stream(2));
  SimulatedInstrument gyroscope(grade.gyroscope, sample_instrument_errors(grade.gyroscope, rng.stream(3)),
                                rng.stream(4));
  SimulatedInstrument magnetometer(grade.magnetometer, sample_instrument_errors(grade.magnetometer, rng.stream(5)),
                                   rng.stream(6));
  const double step = time[1] - time[0];
  for (const double t : time) {
    const Pose before = body.motion(t - h), now = body.motion(t), after = body.motion(t + h);
    const Vec3 acceleration = (after.position - 2.0 * now.position + before.position) / (h * h);
    const Vec3 rate = log_so3(before.rotation.transpose() * after.rotation) / (2.0 * h);
    const Mat3 to_sensor = now.rotation.transpose();
    push_sample(sensor.acceleration,
                accelerometer.read(
                    body.accelerometer_gain * (to_sensor * (acceleration + standard_gravity * Vec3::UnitZ())), step));
    push_sample(sensor.angular_velocity, gyroscope.read(body.gyro_gain * rate, step));
    push_sample(sensor.field, magnetometer.read(to_sensor * magnetic_field_world, step));
  }
  flag_faults(sensor);
  return sensor;
}

}  // namespace

InsRecording record_free_sensors(const std::vector<FreeSensor>& sensors, double seconds, const std::string& grade,
                                 Rng rng) {
  constexpr double sampling_rate = 100.0;  // [Hz]
  InsRecording recording;
  recording.loggers.push_back({"imu.csv", {}});
  for (std::size_t row = 0; row < row_count(seconds, sampling_rate); ++row)
    recording.loggers[0].time.push_back(static_cast<double>(row) / sampling_rate);
  const SensorModel model = sensor_grade(grade).value();
  for (std::size_t s = 0; s < sensors.size(); ++s)
    recording.sensors.push_back(record_free_sensor(sensors[s], recording.loggers[0].time, model, rng.stream(s)));
  return recording;
}

BodyMotion random_motion(Rng rng) {
  const double place = rng.uniform(0.05, 0.4), turn = rng.uniform(0.2, 0.8);
  const SixWaves waves = six_waves(turn, place, [&](double size) { return random_waves(size, rng); });
  const Pose home{random_rotation(rng), Vec3::Zero()};
  return [waves, home](double time) { return waves.at(time) * home; };
}

BodyMotion running_trunk(double pace, Rng rng) {
  const SixWaves waves = six_waves(0.1, 0.04, [&](double size) { return gait_waves(size, pace, rng); });
  return [waves](double time) { return waves.at(time); };
}

BodyMotion loose_segment(const BodyMotion& trunk, double pace, Rng rng) {
  const double turn = rng.uniform(0.2, 0.6), place = rng.uniform(0.02, 0.06);
  const SixWaves waves = six_waves(turn, place, [&](double size) { return gait_waves(size, pace, rng); });
  const Pose home{random_rotation(rng), random_offset(0.5, rng)};
  return [trunk, waves, home](double time) { return trunk(time) * waves.at(time) * home; };
}

BodyMotion wheel_of_car(Rng car, std::size_t index, Rng wheel) {
  constexpr double radius = 0.31, mean_speed = 8.0;  // [m], [m/s]
  Waves speed = random_waves(1.5, car), heading = random_waves(0.25, car);
  for (Waves* waves : {&speed, &heading})
    for (FreeWave& w : *waves) w.frequency *= 0.2;
  const Vec3 axle(index < 2 ? 1.3 : -1.3, index % 2 == 0 ? 0.8 : -0.8, 0.0);
  const double offset = wheel.uniform(0.05, 0.2), start = wheel.uniform(0.0, full_turn);
  const Mat3 mount = random_rotation(wheel);
  return [=](double time) {
    const double share = departure(time);
    // The distance is driven at the mean speed from the departure on, and swings about it.
    const double after = std::max(0.0, time - rest - 1.0);
    const double distance = mean_speed * share * after + share * value_of(speed, time);
    const double yaw = share * value_of(heading, time);
    const Vec3 centre = Vec3(distance, 0.0, 0.0) + rot_z(yaw) * axle;
    const Mat3 turned = rot_z(yaw) * exp_so3(Vec3(0.0, start + distance / radius, 0.0));
    return Pose{Mat3(turned * mount), centre + turned * Vec3(offset, 0.0, 0.0)};
  };
}

BodyMotion fixed_on(const BodyMotion& body, Rng rng) {
  const Pose mount{random_rotation(rng), random_offset(0.8, rng)};
  return [body, mount](double time) { return body(time) * mount; };
}

}  // namespace kinfer::study
