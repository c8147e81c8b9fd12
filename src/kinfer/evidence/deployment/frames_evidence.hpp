// SPDX-License-Identifier: Apache-2.0
// evidence.json of `frames`, as values. SI throughout.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/evidence/deployment/frame_estimate.hpp"

namespace kinfer {

struct FrameRecord {
  Vec3 xyz = Vec3::Zero();  ///< [m]
  Vec3 rpy = Vec3::Zero();  ///< [rad] R = Rz(yaw) Ry(pitch) Rx(roll)
};

struct FramesEvidence {
  FrameRecord base{};
  std::string base_source{};  ///< sentence
  FrameRecord tool{};
  double tool_length = 0.0;                                          ///< [m]
  std::string tool_source{};                                         ///< sentence
  std::optional<ToolLengthSource> tool_length_source{};              ///< none in files of earlier versions
  double base_differs = 0.0, base_turned = 0.0, tool_differs = 0.0;  ///< [m], [rad], [m] from the start of calibrate
  std::vector<SweepCircle> sweeps{};                                 ///< without the index into q
};

}  // namespace kinfer
