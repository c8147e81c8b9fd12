// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/ins_mcap.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/io/recording/ins_topics.hpp"
#include "kinfer/io/robot_log/mcap_writer.hpp"

namespace kinfer {
namespace {

constexpr double tesla = 1e-6;  // per microtesla

struct WrittenSensor {
  const InsSensor* sensor = nullptr;
  std::span<const double> time{};
  std::uint16_t imu = 0, magnetic = 0;
  std::size_t next = 0;
};

void add_triad(CdrMessage& message, const TriadColumns& triad, std::size_t row, double factor) {
  for (std::size_t k = 0; k < 3; ++k) message.number(triad.present() ? factor * triad.axis[k][row] : 0.0);
}

/// Nine numbers, 0: not known; −1: not measured.
void add_covariance(CdrMessage& message, bool is_measured) {
  message.number(is_measured ? 0.0 : -1.0);
  for (int i = 1; i < 9; ++i) message.number(0.0);
}

void write_row(McapWriter& writer, WrittenSensor& at) {
  const InsSensor& sensor = *at.sensor;
  const std::size_t row = at.next++;
  const auto time = static_cast<std::int64_t>(std::llround(1e9 * at.time[row]));
  CdrMessage imu;
  imu.time(time).text(sensor.name);
  for (int i = 0; i < 4; ++i) imu.number(i == 3 ? 1.0 : 0.0);
  add_covariance(imu, false);  // the orientation
  add_triad(imu, sensor.angular_velocity, row, 1.0);
  add_covariance(imu, sensor.angular_velocity.present());
  add_triad(imu, sensor.acceleration, row, 1.0);
  add_covariance(imu, sensor.acceleration.present());
  writer.write(at.imu, time, imu);
  if (!sensor.has_magnetometer() || !std::isfinite(sensor.field.axis[0][row])) return;
  CdrMessage field;
  field.time(time).text(sensor.name);
  add_triad(field, sensor.field, row, tesla);
  add_covariance(field, true);
  writer.write(at.magnetic, time, field);
}

}  // namespace

Result<void> write_ins_mcap(const std::filesystem::path& path, const InsRecording& recording) {
  KINFER_TRY(writer, McapWriter::create(path));
  std::vector<WrittenSensor> sensors;
  for (const InsSensor& sensor : recording.sensors) {
    WrittenSensor written{.sensor = &sensor, .time = recording.time(sensor)};
    written.imu = writer.add_channel(ins_topic(sensor.name), "sensor_msgs/Imu");
    if (sensor.has_magnetometer())
      written.magnetic = writer.add_channel("/" + sensor.name + "/magnetic_field", "sensor_msgs/MagneticField");
    sensors.push_back(written);
  }
  const auto next_time = [](const WrittenSensor& s) {
    return s.next < s.time.size() ? s.time[s.next] : std::numeric_limits<double>::infinity();
  };
  while (!sensors.empty()) {
    WrittenSensor& first = *std::ranges::min_element(sensors, {}, next_time);
    if (first.next == first.time.size()) break;
    write_row(writer, first);
  }
  return writer.finish();
}

}  // namespace kinfer
