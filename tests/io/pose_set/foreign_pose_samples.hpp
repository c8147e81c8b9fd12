// SPDX-License-Identifier: Apache-2.0
// Small files of joint positions and measured points in the formats of other programs, written from one motion.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>

#include "kinfer/base/angle.hpp"
#include "kinfer/geometry/rotation.hpp"

namespace kinfer::test {

constexpr int pose_rows = 12;
constexpr double pose_rate = 125.0;  // [Hz]

inline double sample_joint(int joint, int row) {
  return 0.1 * (joint + 1) + 0.01 * row;
}  // [rad]
inline Vec3 sample_point(int row) {
  return {1.2 + 0.05 * row, -0.4, 0.75 + 0.01 * row};
}  // [m]

inline std::string pose_lines(const std::string& head, const std::function<std::string(int)>& line) {
  std::string text = head;
  for (int row = 0; row < pose_rows; ++row) text += line(row) + "\n";
  return text;
}

inline std::string point_text(int row, const char* separator, double unit = 1e-3, int shift = 0) {
  const Vec3 p = (sample_point(row) + Vec3::Constant(shift)) / unit;
  return fmt::format("{:.6f}{}{:.6f}{}{:.6f}", p.x(), separator, p.y(), separator, p.z());
}

inline std::string ur_rtde() {
  return pose_lines("timestamp target_q_0 target_q_1 actual_q_0 actual_q_1 actual_TCP_pose_0\n", [](int row) {
    return fmt::format("{:.6f} 0 0 {:.9f} {:.9f} 0.3", 1000.0 + row / pose_rate, sample_joint(0, row),
                       sample_joint(1, row));
  });
}

inline std::string kuka_rsi() {
  return pose_lines("", [](int row) {
    return fmt::format(
        "<Rob Type=\"KUKA\"><RIst X=\"1.0\" Y=\"2.0\" Z=\"3.0\" A=\"0.0\" B=\"0.0\" C=\"0.0\"/>"
        "<AIPos A1=\"{:.8f}\" A2=\"{:.8f}\" A3=\"0.0\" A4=\"0.0\" A5=\"0.0\" A6=\"0.0\"/>\n  "
        "<Delay D=\"0\"/><IPOC>{}</IPOC></Rob>",
        sample_joint(0, row) / degree, sample_joint(1, row) / degree, 4208163 + 8 * row);
  });
}

inline std::string kuka_rsi_table() {
  return pose_lines("IPOC,AIPos.A1,AIPos.A2,ASPos.A1\n", [](int row) {
    return fmt::format("{},{:.8f},{:.8f},0", 8 * row, sample_joint(0, row) / degree, sample_joint(1, row) / degree);
  });
}

inline std::string opensim_mot() {
  return pose_lines(
      "Coordinates\nversion=1\nnRows=12\nnColumns=4\ninDegrees=yes\nendheader\n"
      "time\t/jointset/a/shoulder/value\telbow\tpelvis_tx\n",
      [](int row) {
        return fmt::format("{:.6f}\t{:.8f}\t{:.8f}\t0.5", row / pose_rate, sample_joint(0, row) / degree,
                           sample_joint(1, row) / degree);
      });
}

/// Two markers; the second row lacks the first one.
inline std::string opensim_trc() {
  return pose_lines(
      "PathFileType\t4\t(X/Y/Z)\tdrive.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\t"
      "OrigDataStartFrame\tOrigNumFrames\n125.00\t125.00\t12\t2\tmm\t125.00\t1\t12\n"
      "Frame#\tTime\ttip\t\t\tbase\t\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n",
      [](int row) {
        return fmt::format("{}\t{:.6f}\t{}\t{}", row + 1, row / pose_rate, row == 1 ? "\t\t" : point_text(row, "\t"),
                           point_text(row, "\t", 1e-3, 3));
      });
}

inline std::string qualisys_tsv(bool has_column_names) {
  std::string head =
      "NO_OF_FRAMES\t12\nNO_OF_CAMERAS\t8\nNO_OF_MARKERS\t2\nFREQUENCY\t125\nNO_OF_ANALOG\t0\nANALOG_FREQUENCY\t0\n"
      "DESCRIPTION\t--\nTIME_STAMP\t2026-01-01, 10:00:00\nDATA_INCLUDED\t3D\nMARKER_NAMES\ttip\tbase\n";
  if (has_column_names) head += "Frame\tTime\ttip X\ttip Y\ttip Z\tbase X\tbase Y\tbase Z\n";
  return pose_lines(head, [&](int row) {
    const std::string points =
        (row == 1 ? "0.000\t0.000\t0.000" : point_text(row, "\t")) + "\t" + point_text(row, "\t", 1e-3, 3) + "\t";
    return has_column_names ? fmt::format("{}\t{:.6f}\t{}", row + 1, row / pose_rate, points) : points;
  });
}

/// A rigid body with orientation, and one of its markers.
inline std::string motive_csv(const char* unit, double metres) {
  return pose_lines(fmt::format("Format Version,1.23,Take Name,Take,Capture Frame Rate,125.000000,Rotation "
                                "Type,Quaternion,Length Units,{},Coordinate Space,Global\n\n"
                                ",Type,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,"
                                "Rigid Body,Marker,Marker,Marker\n"
                                ",Name,tool,tool,tool,tool,tool,tool,tool,tool,tool:1,tool:1,tool:1\n"
                                ",ID,\"A\",\"A\",\"A\",\"A\",\"A\",\"A\",\"A\",\"A\",\"B\",\"B\",\"B\"\n"
                                ",,Rotation,Rotation,Rotation,Rotation,Position,Position,Position,Error Per "
                                "Marker,Position,Position,Position\n"
                                "Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,,X,Y,Z\n",
                                unit),
                    [&](int row) {
                      return fmt::format("{},{:.6f},0,0,0.6,0.8,{},0.0001,{}", row, row / pose_rate,
                                         row == 1 ? ",," : point_text(row, ",", metres),
                                         point_text(row, ",", metres, 3));
                    });
}

inline std::string spatial_analyzer() {
  return pose_lines("// SpatialAnalyzer points\n// Units: Millimeters\n",
                    [](int row) { return fmt::format("A::Main::p{}, {}", row + 1, point_text(row, ", ")); });
}

inline std::string bare_list(const char* separator, double unit) {
  return pose_lines("", [&](int row) { return point_text(row, separator, unit); });
}

}  // namespace kinfer::test
