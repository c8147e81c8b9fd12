// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/log_faults.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinfer/base/expect.hpp"
#include "kinfer/measurement/ins/ins_selection.hpp"

namespace kinfer {
namespace {

constexpr double closest_stamps = 1e-6;  // [s]

}  // namespace

InsRecording with_clock_fault(const InsRecording& recording, const ClockFault& fault) {
  KINFER_EXPECT(fault.sensor < recording.sensors.size());
  InsRecording result = recording;
  InsSensor& sensor = result.sensors[fault.sensor];
  InsLogger logger = recording.loggers[sensor.logger];
  logger.name = sensor.name + ".csv";
  const double middle = 0.5 * (logger.time.front() + logger.time.back());
  for (double& t : logger.time) t += fault.offset + fault.drift * (t - middle);
  sensor.logger = result.loggers.size();
  result.loggers.push_back(std::move(logger));
  return result;
}

InsRecording with_delayed_rows(const InsRecording& recording, std::size_t sensor, std::size_t rows) {
  KINFER_EXPECT(sensor < recording.sensors.size() && rows < recording.sensors[sensor].rows());
  InsRecording result = recording;
  InsSensor& late = result.sensors[sensor];
  const auto by = static_cast<std::ptrdiff_t>(rows);
  for (TriadColumns* columns : {&late.acceleration, &late.angular_velocity, &late.field})
    for (std::vector<float>& axis : columns->axis) {
      if (axis.empty()) continue;
      std::shift_right(axis.begin(), axis.end(), by);
      std::fill_n(axis.begin(), by, std::numeric_limits<float>::quiet_NaN());
    }
  std::shift_right(late.faults.begin(), late.faults.end(), by);
  std::fill_n(late.faults.begin(), by, std::uint8_t{acceleration_missing | angular_velocity_missing | field_missing});
  return result;
}

InsRecording with_stamp_jitter(const InsRecording& recording, double jitter, Rng rng) {
  const double scale = jitter / std::sqrt(1.0 - 2.0 / std::numbers::pi);  // of a half-normal distribution with this sd
  InsRecording result = recording;
  for (std::size_t l = 0; l < result.loggers.size(); ++l) {
    Rng of_logger = rng.stream(l);
    double before = -std::numeric_limits<double>::infinity();
    for (double& t : result.loggers[l].time) {
      const double late = scale * std::abs(of_logger.normal());
      before = t = std::max(t + late, before + closest_stamps);
    }
  }
  return result;
}

InsRecording with_packets(const InsRecording& recording, std::size_t rows) {
  KINFER_EXPECT(rows > 0);
  InsRecording result = recording;
  for (InsLogger& logger : result.loggers)
    for (std::size_t first = 0; first < logger.time.size(); first += rows) {
      const std::size_t end = std::min(first + rows, logger.time.size());
      const double arrival = logger.time[end - 1];
      for (std::size_t row = first; row < end; ++row)
        logger.time[row] = arrival + closest_stamps * static_cast<double>(row - first);
    }
  return result;
}

MachineMotion with_remount(MachineMotion motion, std::size_t sensor, std::size_t row, const Pose& old_T_new) {
  KINFER_EXPECT(sensor < motion.sensors.size() && motion.time.size() > 2);
  SensorMotion& m = motion.sensors[sensor];
  const SensorMotion was = m;
  const double period = motion.time[1] - motion.time[0];
  const Mat3 new_R_old = old_T_new.rotation.transpose();
  const Vec3& lever = old_T_new.position;
  for (std::size_t i = row; i < motion.time.size(); ++i) {
    const std::size_t before = i > 0 ? i - 1 : i, after = std::min(i + 1, motion.time.size() - 1);
    const Vec3 angular_acceleration =
        (was.angular_velocity[after] - was.angular_velocity[before]) / (period * static_cast<double>(after - before));
    const Vec3& angular_velocity = was.angular_velocity[i];
    m.force[i] = new_R_old * (was.force[i] + angular_acceleration.cross(lever) +
                              angular_velocity.cross(angular_velocity.cross(lever)));
    m.angular_velocity[i] = new_R_old * angular_velocity;
    m.field[i] = new_R_old * was.field[i];
    m.position[i] += was.world_R_sensor[i] * lever;
    m.world_R_sensor[i] = was.world_R_sensor[i] * Quat(old_T_new.rotation);
  }
  return motion;
}

InsRecording merge_recordings(const InsRecording& one, const InsRecording& other, const std::string& prefix) {
  KINFER_EXPECT(one.loggers.size() == 1 && other.loggers.size() == 1);
  const double end = std::min(one.loggers[0].time.back(), other.loggers[0].time.back());
  InsRecording result = within(one, one.loggers[0].time.front(), end);
  const std::size_t rows = result.loggers[0].time.size();
  const InsRecording more = within(other, other.loggers[0].time.front(), end);
  KINFER_EXPECT(more.loggers[0].time.size() == rows);
  for (InsSensor sensor : more.sensors) {
    sensor.name = prefix + sensor.name;
    result.sensors.push_back(std::move(sensor));
  }
  return result;
}

}  // namespace kinfer
