// SPDX-License-Identifier: Apache-2.0
#include "studies/support/corpus.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kinfer/base/expect.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "kinfer/simulate/log_faults.hpp"
#include "kinfer/simulate/mujoco_world.hpp"
#include "studies/support/free_motion.hpp"

namespace kinfer::study {
namespace {

constexpr const char* grade_names[] = {"noise", "industrial", "consumer"};
constexpr double sampling_rate = 100.0;  // [Hz]
constexpr double free_seconds = 45.0;

struct MachineLog {
  InsRecording recording;
  MachineTruth truth;
};

MachineLog machine_log(const std::string& machine, const std::string& grade, Script script, Base base,
                       std::uint64_t seed) {
  const Rng rng(seed);
  const MachineOptions build{.mounting = Mounting::arbitrary, .base = base};
  const auto world = MujocoWorld::load(machine_mjcf(machine, build, rng.stream(1)).value()).value();
  const Drive drive = make_drive(world.machine(), {.script = script}, rng.stream(2)).value();
  const MachineMotion motion = world.prescribe(drive, sampling_rate);
  return {simulate_recording(world.machine(), motion, sensor_grade(grade).value(), {}, rng.stream(3)),
          machine_truth(world.machine(), motion)};
}

std::string machine_at(std::size_t index) {
  const auto names = machine_names();
  return names[index % names.size()];
}

const char* grade_at(std::size_t index) {
  return grade_names[index % std::size(grade_names)];
}

/// Any machine's sensor, the root's excepted.
InsSensor any_sensor(std::uint64_t seed, std::size_t index) {
  const InsRecording recording =
      machine_log(machine_at(index), grade_at(index / 2), Script::together, Base::still, seed).recording;
  return recording.sensors[1 + Rng(seed).stream(9).index(recording.sensors.size() - 1)];
}

InsRecording of_sensors(std::vector<InsSensor> sensors) {
  std::size_t rows = sensors.front().rows();
  for (const InsSensor& s : sensors) rows = std::min(rows, s.rows());
  InsRecording recording;
  recording.loggers.push_back({"imu.csv", {}});
  for (std::size_t row = 0; row < rows; ++row)
    recording.loggers[0].time.push_back(static_cast<double>(row) / sampling_rate);
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    sensors[s].name = fmt::format("ins{}", s);
    for (TriadColumns* columns : {&sensors[s].acceleration, &sensors[s].angular_velocity, &sensors[s].field})
      for (auto& axis : columns->axis)
        if (!axis.empty()) axis.resize(rows);
    sensors[s].faults.resize(rows);
  }
  recording.sensors = std::move(sensors);
  return recording;
}

InsRecording unrelated(std::uint64_t seed, std::size_t index) {
  Rng rng(seed);
  const std::size_t count = 2 + rng.index(4);
  if (index % 2 == 0) {
    std::vector<FreeSensor> bodies;
    for (std::size_t i = 0; i < count; ++i) bodies.push_back({fmt::format("ins{}", i), random_motion(rng.stream(i))});
    return record_free_sensors(bodies, free_seconds, grade_at(index / 2), rng.stream(50));
  }
  std::vector<InsSensor> sensors;
  for (std::size_t i = 0; i < count; ++i) sensors.push_back(any_sensor(1000 * seed + i, index + i));
  return of_sensors(std::move(sensors));
}

/// From the middle row on, the samples of `other`.
void replace_second_half(InsSensor& sensor, const InsSensor& other) {
  const std::size_t rows = std::min(sensor.rows(), other.rows());
  const auto swap_columns = [&](TriadColumns& to, const TriadColumns& from) {
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t row = rows / 2; row < rows && to.present() && from.present(); ++row)
        to.axis[k][row] = from.axis[k][row];
  };
  swap_columns(sensor.acceleration, other.acceleration);
  swap_columns(sensor.angular_velocity, other.angular_velocity);
  swap_columns(sensor.field, other.field);
  for (std::size_t row = rows / 2; row < rows; ++row) sensor.faults[row] = other.faults[row];
}

InsRecording shuffled(std::uint64_t seed, std::size_t index) {
  Rng rng(seed);
  const Script script = index % 2 == 0 ? Script::together : Script::standard;
  MachineLog log = machine_log(machine_at(index), grade_at(index), script, Base::still, seed);
  std::vector<InsSensor>& sensors = log.recording.sensors;
  const std::size_t s = 1 + rng.index(sensors.size() - 1);
  if (index % 4 < 2) {
    replace_second_half(
        sensors[s],
        machine_log(machine_at(index), grade_at(index), script, Base::still, seed + 500).recording.sensors[s]);
    return log.recording;
  }
  const std::size_t t = 1 + (s + rng.index(sensors.size() - 2)) % (sensors.size() - 1);
  const InsSensor first = sensors[s], second = sensors[t];
  replace_second_half(sensors[s], second);
  replace_second_half(sensors[t], first);
  return log.recording;
}

InsRecording running_body(std::uint64_t seed, std::size_t index) {
  Rng rng(seed);
  const double pace = rng.uniform(1.0, 1.6);
  const std::size_t count = 3 + rng.index(4);
  const BodyMotion trunk = running_trunk(pace, rng.stream(1));
  std::vector<FreeSensor> sensors;
  for (std::size_t i = 0; i < count; ++i)
    sensors.push_back({fmt::format("ins{}", i), loose_segment(trunk, pace, rng.stream(10 + i))});
  return record_free_sensors(sensors, free_seconds, grade_at(index), rng.stream(2));
}

InsRecording twice(std::uint64_t seed, std::size_t index) {
  InsRecording recording =
      machine_log(machine_at(index), grade_at(index), Script::standard, Base::still, seed).recording;
  InsSensor copy = recording.sensors[1 + Rng(seed).index(recording.sensors.size() - 1)];
  copy.name = "copy";
  recording.sensors.push_back(std::move(copy));
  return recording;
}

InsRecording wheels(std::uint64_t seed, std::size_t index) {
  Rng rng(seed);
  const std::size_t count = 2 + rng.index(3);
  std::vector<FreeSensor> sensors;
  for (std::size_t i = 0; i < count; ++i) {
    const double gyro_gain = rng.uniform(0.6, 1.5), accelerometer_gain = rng.uniform(0.8, 1.2);
    sensors.push_back(
        {fmt::format("wheel{}", i), wheel_of_car(rng.stream(1), i, rng.stream(10 + i)), gyro_gain, accelerometer_gain});
  }
  return record_free_sensors(sensors, free_seconds, grade_at(index), rng.stream(2));
}

InsRecording stick(std::uint64_t seed, std::size_t index) {
  Rng rng(seed);
  const BodyMotion body = random_motion(rng.stream(1));
  std::vector<FreeSensor> sensors;
  for (std::size_t i = 0; i < 2 + index % 2; ++i)
    sensors.push_back({fmt::format("ins{}", i), fixed_on(body, rng.stream(10 + i))});
  return record_free_sensors(sensors, free_seconds, grade_at(index), rng.stream(2));
}

struct Nonsense {
  std::string kind;
  InsRecording (*make)(std::uint64_t seed, std::size_t index);
};

const std::vector<Nonsense>& nonsense() {
  static const std::vector<Nonsense> all{{"unrelated", unrelated}, {"shuffled", shuffled}, {"bodies", running_body},
                                         {"twice", twice},         {"wheels", wheels},     {"stick", stick}};
  return all;
}

}  // namespace

const std::vector<std::string>& nonsense_kinds() {
  static const std::vector<std::string> kinds = [] {
    std::vector<std::string> names;
    for (const Nonsense& n : nonsense()) names.push_back(n.kind);
    return names;
  }();
  return kinds;
}

JudgedLog sound_log(std::uint64_t seed, std::size_t index) {
  constexpr Script scripts[] = {Script::standard, Script::together, Script::vigorous, Script::standard,
                                Script::gentle,   Script::standard, Script::quick};
  constexpr const char* script_names[] = {"standard", "together", "vigorous", "standard",
                                          "gentle",   "standard", "quick"};
  const std::size_t machines = machine_names().size();
  const std::string machine = machine_at(index);
  const char* grade = grade_at(index / machines);
  const std::size_t script = (index / (3 * machines)) % std::size(scripts);
  const Base base = index % 11 == 10 ? Base::rocking : Base::still;
  MachineLog log = machine_log(machine, grade, scripts[script], base, seed);
  return {"sound", fmt::format("{} {} {} {}", machine, grade, script_names[script], seed), std::move(log.recording),
          std::move(log.truth)};
}

JudgedLog nonsense_log(const std::string& kind, std::uint64_t seed, std::size_t index) {
  const auto found = std::ranges::find(nonsense(), kind, &Nonsense::kind);
  KINFER_EXPECT(found != nonsense().end(), "no kind {}", kind);
  return {kind, fmt::format("{} {}", kind, seed), found->make(seed, index)};
}

}  // namespace kinfer::study
