// SPDX-License-Identifier: Apache-2.0
// A tracking model made from the ground truth of a simulated machine, and its recording row by row.
#pragma once

#include <algorithm>
#include <cmath>

#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/measurement/ins/ins_row.hpp"
#include "kinfer/measurement/sensor_model.hpp"
#include "kinfer/simulate/excitation.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "kinfer/simulate/mujoco_world.hpp"

namespace kinfer::test {

/// Standard deviations of a geometry that is nearly the true one.
struct GeometrySd {
  double rotation = 1e-4, point = 1e-3;  ///< [rad], [m]
};

inline void append_parameters(TrackingModel& model, std::vector<double>& sd, TrackingParameterKind kind, int index,
                              int count, double value) {
  for (int c = 0; c < count; ++c) {
    model.parameters.push_back({kind, index, c});
    sd.push_back(value);
  }
}

/// The chain as built, its sensors with the errors of a grade yet unknown. Joint positions are those of the machine.
inline TrackingModel tracking_model_of(const Machine& machine, const SensorModel& grade, double sampling_rate,
                                       const GeometrySd& geometry = {}) {
  using Kind = TrackingParameterKind;
  TrackingModel model;
  std::vector<double> sd;
  const auto noise = [&](const InstrumentModel& m) {
    return std::hypot(m.noise_density * std::sqrt(0.5 * sampling_rate), m.resolution / std::sqrt(12.0));
  };
  for (std::size_t s = 0; s < machine.sensors.size(); ++s) {
    const MountedSensor& mounted = machine.sensors[s];
    const int index = static_cast<int>(s);
    TrackingSensor sensor{.name = mounted.name, .body = index};
    sensor.noise = sensor.residual = sensor.slow_residual = {noise(grade.gyroscope), noise(grade.accelerometer)};
    sensor.sample_period = 1.0 / sampling_rate;
    model.sensors.push_back(sensor);
    TrackingBody body{.parent = mounted.parent, .sensor = index, .joint = index - 1};
    if (s > 0) {
      const MountedSensor& parent = machine.sensors[static_cast<std::size_t>(mounted.parent)];
      const Joint& joint = machine.chain.joints[static_cast<std::size_t>(mounted.joint)];
      const auto& link = std::get<UrdfLink>(joint.link);
      const Pose parent_T_joint = parent.segment_T_sensor.inverse() * link.origin.pose();
      const Pose parent_T_child = parent_T_joint * mounted.segment_T_sensor;
      body.motion = translates(joint.type) ? TrackingMotion::prismatic : TrackingMotion::revolute;
      body.parent_R_axis = frame_with_z_along(parent_T_joint.rotation * link.axis);
      body.child_R_axis = parent_T_child.rotation.transpose() * body.parent_R_axis;
      body.point_in_parent = translates(joint.type) ? parent_T_child.position : parent_T_joint.position;
      body.point_in_child = translates(joint.type) ? Vec3(Vec3::Zero()) : mounted.segment_T_sensor.inverse().position;
      model.joints.push_back({.name = joint.name, .first_position = index - 1});
      append_parameters(model, sd, Kind::parent_rotation, index, 2, geometry.rotation);
      append_parameters(model, sd, Kind::child_rotation, index, translates(joint.type) ? 3 : 2, geometry.rotation);
      append_parameters(model, sd, Kind::point_in_parent, index, 3, geometry.point);
      if (!translates(joint.type)) append_parameters(model, sd, Kind::point_in_child, index, 3, geometry.point);
    }
    append_parameters(model, sd, Kind::gyroscope_bias, index, 3, grade.gyroscope.bias_sd);
    append_parameters(model, sd, Kind::accelerometer_bias, index, 3, grade.accelerometer.bias_sd);
    append_parameters(model, sd, Kind::gyroscope_scale, index, 9, grade.gyroscope.scale_sd);
    append_parameters(model, sd, Kind::accelerometer_scale, index, 9, grade.accelerometer.scale_sd);
    model.bodies.push_back(body);
  }
  model.prior = {.bias = {grade.gyroscope.bias_sd, grade.accelerometer.bias_sd},
                 .scale = {grade.gyroscope.scale_sd, grade.accelerometer.scale_sd},
                 .bias_instability = {grade.gyroscope.instability, grade.accelerometer.instability}};
  const Eigen::Map<const VectorXd> all(sd.data(), static_cast<Eigen::Index>(sd.size()));
  model.covariance = all.cwiseAbs2().asDiagonal();
  model.tool.body = static_cast<int>(model.bodies.size()) - 1;
  expect_well_formed(model);
  return model;
}

/// Row `row` of a recording with one logger.
inline void fill_row(const InsRecording& recording, std::size_t row, InsRow& to) {
  to.time = recording.loggers.front().time[row];
  to.sensors.resize(recording.sensors.size());
  for (std::size_t s = 0; s < recording.sensors.size(); ++s)
    to.sensors[s] = sample(recording.sensors[s], recording.time(recording.sensors[s]), row);
}

/// A machine that moves, with its truth.
struct SimulatedDrive {
  Machine machine;
  MachineMotion motion;
  InsRecording recording;

  /// True position, velocity, acceleration of joint position `joint` of the chain behind the base sensor.
  double q(int joint, std::size_t row) const {
    return motion.q(machine.base_dof + joint, static_cast<Eigen::Index>(row));
  }
  double qd(int joint, std::size_t row) const {
    return motion.qd(machine.base_dof + joint, static_cast<Eigen::Index>(row));
  }
  double qdd(int joint, std::size_t row) const {
    return motion.qdd(machine.base_dof + joint, static_cast<Eigen::Index>(row));
  }
};

struct DriveSetup {
  std::string machine = "excavator-general", grade = "industrial";
  Script script = Script::standard;
  Base base = Base::still;
  double slope = 0.0, duration = 0.0, sampling_rate = 200.0;
  std::uint64_t machine_seed = 1, drive_seed = 2, sensor_seed = 3;
  SensorFaults faults{};
};

inline SimulatedDrive simulated_drive(const DriveSetup& setup) {
  const auto mjcf = machine_mjcf(setup.machine, {.base = setup.base, .slope = Angle::deg(setup.slope)},
                                 Rng(setup.machine_seed).stream(1))
                        .value();
  const MujocoWorld world = MujocoWorld::load(mjcf).value();
  const auto drive =
      make_drive(world.machine(), {.script = setup.script, .duration = setup.duration}, Rng(setup.drive_seed).stream(2))
          .value();
  MachineMotion motion = world.prescribe(drive, setup.sampling_rate);
  InsRecording recording = simulate_recording(world.machine(), motion, *sensor_grade(setup.grade), setup.faults,
                                              Rng(setup.sensor_seed).stream(3));
  return {world.machine(), std::move(motion), std::move(recording)};
}

}  // namespace kinfer::test
