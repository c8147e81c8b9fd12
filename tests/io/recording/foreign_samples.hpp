// SPDX-License-Identifier: Apache-2.0
// Small logs in the formats of other programs, written from one motion.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/constants.hpp"
#include "kinfer/geometry/rotation.hpp"

namespace kinfer::test {

constexpr int sample_rows = 60;
constexpr double sample_rate = 100.0;  // [Hz]

inline Vec3 sample_force(int row) {
  return {0.5, -1.0 + 0.01 * row, 9.7};
}  // [m/s²]
inline Vec3 sample_rates(int row) {
  return {0.1, 0.002 * row, -0.2};
}  // [rad/s]
inline Vec3 sample_field(int row) {
  return {20.0 + 0.1 * row, 1.0, -44.0};
}  // [µT]

/// One line per row of the motion after `head`.
inline std::string lines(const std::string& head, const std::function<std::string(int)>& line) {
  std::string text = head;
  for (int row = 0; row < sample_rows; ++row) text += line(row) + "\n";
  return text;
}

/// The three numbers with `separator` between them.
inline std::string three(const Vec3& v, const char* separator = ",", double unit = 1.0) {
  return fmt::format("{:.7f}{}{:.7f}{}{:.7f}", v.x() / unit, separator, v.y() / unit, separator, v.z() / unit);
}

inline std::string xsens_txt() {
  return lines(
      "// Start Time: Unknown\r\n// Update Rate: 100.0Hz\r\n// Filter Profile: human (46.1)\r\n"
      "PacketCounter\tSampleTimeFine\tAcc_X\tAcc_Y\tAcc_Z\tFreeAcc_E\tFreeAcc_N\tFreeAcc_U\tGyr_X\tGyr_Y\tGyr_Z\t"
      "Mag_X\tMag_Y\tMag_Z\r\n",
      [](int row) {
        return fmt::format("{:05}\t\t{}\t0.1\t0.1\t0.1\t{}\t{}\r", (65500 + row) % 65536,
                           three(sample_force(row), "\t"), three(sample_rates(row), "\t"),
                           three(sample_field(row), "\t", 50.0));
      });
}

inline std::string movella_dot() {
  return lines(
      "sep=,\nDeviceTag:,Sensor 1\nFirmwareVersion:,2.0.0\nOutputRate:,100\n"
      "PacketCounter,SampleTimeFine,Quat_W,Quat_X,Quat_Y,Quat_Z,Acc_X,Acc_Y,Acc_Z,Gyr_X,Gyr_Y,Gyr_Z,Mag_X,Mag_Y,Mag_Z,"
      "\n",
      [](int row) {
        return fmt::format("{},{},1,0,0,0,{},{},{},", row + 1, (4294900000LL + 10000LL * row) % 4294967296LL,
                           three(sample_force(row)), three(sample_rates(row), ",", degree),
                           three(sample_field(row), ",", 50.0));
      });
}

inline std::string phyphox(const std::string& instrument) {
  const bool is_force = instrument == "Accelerometer";
  const std::string name = is_force ? "Acceleration" : "Gyroscope", unit = is_force ? "m/s^2" : "rad/s";
  return lines(fmt::format("\"Time (s)\";\"{0} x ({1})\";\"{0} y ({1})\";\"{0} z ({1})\"\n", name, unit), [&](int row) {
    return fmt::format("{:.9E};{}", row / sample_rate + (is_force ? 0.0 : 0.002),
                       three(is_force ? sample_force(row) : sample_rates(row), ";"));
  });
}

inline std::string sensor_logger(Vec3 (*value)(int), double unit) {
  return lines("time,seconds_elapsed,z,y,x\n", [&](int row) {
    const Vec3 v = value(row) / unit;
    return fmt::format("{},{:.3f},{:.7f},{:.7f},{:.7f}", 1700000000000000000LL + 10000000LL * row, row / sample_rate,
                       v.z(), v.y(), v.x());
  });
}

inline std::string x_io() {
  return lines(
      "Time (s),Gyroscope X (deg/s),Gyroscope Y (deg/s),Gyroscope Z (deg/s),Accelerometer X (g),Accelerometer Y (g),"
      "Accelerometer Z (g),Magnetometer X (uT),Magnetometer Y (uT),Magnetometer Z (uT)\n",
      [](int row) {
        return fmt::format("{:.3f},{},{},{}", row / sample_rate, three(sample_rates(row), ",", degree),
                           three(sample_force(row), ",", standard_gravity), three(sample_field(row)));
      });
}

inline std::string microstrain() {
  return lines(
      "FILE_INFO_START\nReport Time,01/01/2026\nFILE_INFO_END\n\nDATA_START\n"
      "Time,X Accel [x8004],Y Accel [x8004],Z Accel [x8004],X Gyro [x8005],Y Gyro [x8005],Z Gyro [x8005]\n",
      [](int row) {
        return fmt::format("01/01/2026 23:59:59.{:03},{},{}", 10 * row, three(sample_force(row), ",", standard_gravity),
                           three(sample_rates(row)));
      });
}

inline std::string sbg_text() {
  return lines(
      "timestamp\tstatus\taccelX\taccelY\taccelZ\tgyroX\tgyroY\tgyroZ\ttemperature\n"
      "(us)\t(na)\t(m.s^-2)\t(m.s^-2)\t(m.s^-2)\t(deg.s^-1)\t(deg.s^-1)\t(deg.s^-1)\t(degC)\n",
      [](int row) {
        return fmt::format("{}\t0x7F\t{}\t{}\t25.5", (4294900000LL + 10000LL * row) % 4294967296LL,
                           three(sample_force(row), "\t"), three(sample_rates(row), "\t", degree));
      });
}

/// Between messages of another kind, as a serial port's log has them.
inline std::string vectornav_imu() {
  return lines("", [](int row) {
    return fmt::format("$VNYPR,+010.000,+000.000,+000.000*5A\n$VNIMU,{},{},{},+20.7,+084.322*66",
                       three(sample_field(row), ",", 100.0), three(sample_force(row)), three(sample_rates(row)));
  });
}

inline std::string vectornav_ymr() {
  return lines("", [](int row) {
    return fmt::format("$VNYMR,+010.000,+000.000,+000.000,{},{},{}*66", three(sample_field(row), ",", 100.0),
                       three(sample_force(row)), three(sample_rates(row)));
  });
}

}  // namespace kinfer::test
