// SPDX-License-Identifier: Apache-2.0
#include "studies/track/drives.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "kinfer/identify/pipeline.hpp"
#include "kinfer/simulate/mujoco_world.hpp"
#include "support/tracked_machine.hpp"

namespace kinfer::study::track_study {
namespace {

/// A value of a triad's columns.
void set_row(TriadColumns& columns, std::size_t row, const Vec3& value) {
  for (std::size_t k = 0; k < 3; ++k) columns.axis[k][row] = static_cast<float>(value[static_cast<Eigen::Index>(k)]);
}

/// Acceleration of a play that snaps from side to side, smoothed over some rows.
double play_acceleration(double time, double size) {
  constexpr double frequency = 3.0;  // [Hz] of the rattle
  const double w = 2.0 * std::numbers::pi * frequency;
  return -size * w * w * std::sin(w * time);
}

SensorModel with_known_errors(SensorModel model) {
  for (InstrumentModel* instrument : {&model.gyroscope, &model.accelerometer, &model.magnetometer})
    instrument->bias_sd = instrument->scale_sd = 0.0;
  return model;
}

bool is_beyond(const Machine& machine, std::size_t sensor, std::size_t first) {
  for (int s = static_cast<int>(sensor); s >= 0; s = machine.sensors[static_cast<std::size_t>(s)].parent)
    if (s == static_cast<int>(first)) return true;
  return false;
}

/// The pin before a sensor rattles: all beyond it move alike.
void rattle(const InjectedFault& fault, SimulatedDrive& drive) {
  const std::vector<SensorMotion>& truth = drive.motion.sensors;
  for (std::size_t s = 0; s < truth.size(); ++s) {
    if (!is_beyond(drive.machine, s, fault.sensor)) continue;
    InsSensor& sensor = drive.recording.sensors[s];
    const auto time = drive.recording.time(sensor);
    for (std::size_t row = 0; row < sensor.rows(); ++row) {
      if (time[row] < fault.begin || time[row] > fault.end) continue;
      const Vec3 shake = play_acceleration(time[row], 0.5 * fault.size) * Vec3::UnitX();
      const Quat turn = truth[s].world_R_sensor[row].conjugate() * truth[fault.sensor].world_R_sensor[row];
      set_row(sensor.acceleration, row, sensor.acceleration.at(row) + turn * shake);
    }
  }
}

/// Rows hold the samples of earlier ones.
void delay(const InjectedFault& fault, SimulatedDrive& drive) {
  InsSensor& sensor = drive.recording.sensors[fault.sensor];
  const auto time = drive.recording.time(sensor);
  const auto rows = static_cast<std::size_t>(std::lround(fault.size / (time[1] - time[0])));
  for (std::size_t row = sensor.rows(); row-- > rows;) {
    if (time[row] < fault.begin || time[row] > fault.end) continue;
    set_row(sensor.acceleration, row, sensor.acceleration.at(row - rows));
    set_row(sensor.angular_velocity, row, sensor.angular_velocity.at(row - rows));
  }
}

}  // namespace

SimulatedDrive simulate_drive(const DriveSetup& setup) {
  const auto mjcf = machine_mjcf(setup.machine, {.base = setup.base}, Rng(setup.machine_seed).stream(1)).value();
  const MujocoWorld world = MujocoWorld::load(mjcf).value();
  const auto drive =
      make_drive(world.machine(), {.script = setup.script, .duration = setup.duration}, Rng(setup.drive_seed).stream(2))
          .value();
  MachineMotion motion = world.prescribe(drive, 200.0);
  const std::uint64_t drive_number = setup.drive_seed == setup.machine_seed ? 1 : setup.drive_seed;
  const SensorModel grade = *sensor_grade(setup.grade);
  InsRecording recording =
      simulate_recording(world.machine(), motion, setup.known_sensors ? with_known_errors(grade) : grade,
                         {.magnetic_disturbance = setup.steel}, Rng(setup.machine_seed).stream(3), drive_number);
  return {world.machine(), std::move(motion), std::move(recording)};
}

Result<TrackingModel> identify_drive(const SimulatedDrive& drive) {
  KINFER_TRY(found, identify::identify_machine(drive.recording, {.threads = 1}, Rng(1), {}));
  if (!found.tracking) return error("no tracking model");
  return *found.tracking;
}

TrackingModel exact_model(const SimulatedDrive& drive, const std::string& grade) {
  return test::tracking_model_of(drive.machine, with_known_errors(*sensor_grade(grade)), 200.0,
                                 {.rotation = 1e-7, .point = 1e-6});
}

void change_biases(double share, const std::string& grade, std::uint64_t seed, SimulatedDrive& drive) {
  const SensorModel model = *sensor_grade(grade);
  Rng rng = Rng(seed).stream(4);
  for (InsSensor& sensor : drive.recording.sensors) {
    Vec3 rate, force;
    for (Eigen::Index k = 0; k < 3; ++k) {
      rate[k] = share * model.gyroscope.bias_sd * rng.normal();
      force[k] = share * model.accelerometer.bias_sd * rng.normal();
    }
    for (std::size_t row = 0; row < sensor.rows(); ++row) {
      set_row(sensor.angular_velocity, row, sensor.angular_velocity.at(row) + rate);
      set_row(sensor.acceleration, row, sensor.acceleration.at(row) + force);
    }
  }
}

void inject(const InjectedFault& fault, SimulatedDrive& drive) {
  if (fault.kind == FaultKind::none) return;
  if (fault.kind == FaultKind::play) return rattle(fault, drive);
  if (fault.kind == FaultKind::late) return delay(fault, drive);
  InsSensor& sensor = drive.recording.sensors[fault.sensor];
  const auto time = drive.recording.time(sensor);
  const Mat3 turn = exp_so3(fault.size * Vec3(1.0, 1.0, 1.0).normalized());
  for (std::size_t row = 1; row < sensor.rows(); ++row) {
    const Vec3 rate = sensor.angular_velocity.at(row);
    if (time[row] < fault.begin || time[row] > fault.end) continue;
    const Vec3 force = sensor.acceleration.at(row);
    switch (fault.kind) {
      case FaultKind::turned:
        set_row(sensor.acceleration, row, turn.transpose() * force);
        set_row(sensor.angular_velocity, row, turn.transpose() * rate);
        break;
      case FaultKind::shifted: {
        const SensorMotion& truth = drive.motion.sensors[fault.sensor];
        const Vec3 w = truth.angular_velocity[row],
                   change = (w - truth.angular_velocity[row - 1]) / (time[row] - time[row - 1]);
        const Vec3 arm = fault.size * Vec3(1.0, 1.0, 1.0).normalized();
        set_row(sensor.acceleration, row, force + change.cross(arm) + w.cross(w.cross(arm)));
        break;
      }
      case FaultKind::lost:
        sensor.faults[row] |= acceleration_missing | angular_velocity_missing;
        set_row(sensor.acceleration, row, Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
        set_row(sensor.angular_velocity, row, Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
        break;
      case FaultKind::play:
      case FaultKind::late:
      case FaultKind::none:
        break;
    }
  }
}

}  // namespace kinfer::study::track_study
