// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/pose_set/predictions_csv.hpp"

#include <iterator>

namespace kinfer {

Result<std::string> format_predictions_csv(std::span<const Pose> poses, const PoseSet& set, const Pose& world_T_base,
                                           std::span<const Vec3> anchors, std::span<const PoseDeviations> deviations) {
  std::vector<int> anchor_of_row(poses.size(), -1);
  for (const DistanceMeasurement& wire : set.distances) {
    if (wire.anchor >= static_cast<int>(anchors.size()))
      return error("row {}: anchor {}: the robot file lists {} anchors", wire.row, wire.anchor + 1, anchors.size());
    anchor_of_row[wire.row] = wire.anchor;
  }
  std::string text = "x,y,z,qw,qx,qy,qz";
  if (!deviations.empty()) text += ",sd_x,sd_y,sd_z,sd_rx,sd_ry,sd_rz";
  text += set.distances.empty() ? "\n" : ",distance\n";
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Vec3& p = poses[i].position;
    Quat q(poses[i].rotation);
    if (q.w() < 0.0) q.coeffs() *= -1.0;
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{}", p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
    if (!deviations.empty()) {
      const auto& [position, rotation] = deviations[i];
      for (const double sd : {position.x(), position.y(), position.z(), rotation.x(), rotation.y(), rotation.z()})
        fmt::format_to(std::back_inserter(text), ",{:.6g}", sd);
    }
    if (!set.distances.empty()) {
      text += ',';
      if (anchor_of_row[i] >= 0)
        fmt::format_to(std::back_inserter(text), "{}", (p - world_T_base * anchors[anchor_of_row[i]]).norm());
    }
    text += '\n';
  }
  return text;
}

}  // namespace kinfer
