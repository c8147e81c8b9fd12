// SPDX-License-Identifier: Apache-2.0
#include "studies/update/drives.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kinfer/measurement/ins/ins_selection.hpp"
#include "kinfer/simulate/excitation.hpp"
#include "kinfer/simulate/mujoco_world.hpp"

namespace kinfer::study::update_study {
namespace {

constexpr double sampling_rate = 100.0;  // [Hz]

/// "x y z" of a body of a machine's file, its x larger by `by`.
std::string with_moved_pin(std::string mjcf, const std::string& body, double by) {
  const std::size_t at = mjcf.find("<body name=\"" + body + "\""), begin = mjcf.find("pos=\"", at) + 5,
                    end = mjcf.find_first_of(" \"", begin);
  const double x = std::stod(mjcf.substr(begin, end - begin));
  return mjcf.replace(begin, end - begin, fmt::format("{}", x + by));
}

MujocoWorld world_of(const UpdateSetup& setup, const std::string& pin) {
  std::string mjcf =
      machine_mjcf(setup.machine, {.mounting = Mounting::arbitrary}, Rng(setup.machine_seed).stream(1)).value();
  if (!pin.empty()) mjcf = with_moved_pin(std::move(mjcf), pin, setup.moved_by);
  return MujocoWorld::load(mjcf).value();
}

MachineMotion motion_of(const MujocoWorld& world, std::uint64_t seed) {
  return world.prescribe(make_drive(world.machine(), {}, Rng(seed).stream(2)).value(), sampling_rate);
}

template <class T>
void append(std::vector<T>& list, const std::vector<T>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

/// One motion after the other, for the same sensors with the same errors.
MachineMotion one_after_the_other(MachineMotion first, const MachineMotion& second) {
  const double shift = first.time.back() + 1.0 / sampling_rate;
  for (const double time : second.time) first.time.push_back(time + shift);
  for (std::size_t s = 0; s < first.sensors.size(); ++s) {
    SensorMotion& sensor = first.sensors[s];
    append(sensor.world_R_sensor, second.sensors[s].world_R_sensor);
    append(sensor.position, second.sensors[s].position);
    append(sensor.force, second.sensors[s].force);
    append(sensor.angular_velocity, second.sensors[s].angular_velocity);
    append(sensor.field, second.sensors[s].field);
  }
  return first;
}

}  // namespace

UpdateDrive update_drive(const UpdateSetup& setup) {
  const MujocoWorld before = world_of(setup, ""), after = world_of(setup, setup.moved_pin);
  const MachineMotion first = motion_of(before, setup.machine_seed),
                      second = motion_of(after, 1000 * setup.machine_seed + static_cast<std::uint64_t>(setup.drive));
  const InsRecording both =
      simulate_recording(after.machine(), one_after_the_other(first, second), *sensor_grade(setup.grade),
                         {.has_magnetometer = false}, Rng(setup.machine_seed).stream(3));
  const double middle = first.time.back() + 0.5 / sampling_rate;
  if (setup.drive == 0) return {within(both, -1.0, middle), machine_truth(before.machine(), first)};
  return {within(both, middle, 2.0 * middle + second.time.back()), machine_truth(after.machine(), second)};
}

void turn_sensor(UpdateDrive& drive, std::size_t sensor, double angle) {
  const Mat3 turn = exp_so3(angle * Vec3(1.0, 1.0, 1.0).normalized());
  InsSensor& turned = drive.recording.sensors[sensor];
  for (TriadColumns* columns : {&turned.acceleration, &turned.angular_velocity})
    for (std::size_t row = 0; row < turned.rows(); ++row) {
      const Vec3 value = turn.transpose() * columns->at(row);
      for (std::size_t k = 0; k < 3; ++k)
        columns->axis[k][row] = static_cast<float>(value[static_cast<Eigen::Index>(k)]);
    }
  for (JointTruth& joint : drive.truth.joints) {
    if (joint.child == turned.name) joint.axis_in_child = turn.transpose() * joint.axis_in_child;
    if (joint.parent == turned.name) joint.axis_in_parent = turn.transpose() * joint.axis_in_parent;
  }
}

}  // namespace kinfer::study::update_study
