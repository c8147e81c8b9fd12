// SPDX-License-Identifier: Apache-2.0
// What a calibration changes in the robot file that it was given, when it is written back into that file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinfer/geometry/rotation.hpp"
#include "kinfer/kinematics/geometric_part.hpp"

namespace kinfer {

/// Formats of robot files that are written back.
enum class RobotFileFormat { urdf, mjcf };
constexpr std::string_view name(RobotFileFormat format) {
  return format == RobotFileFormat::urdf ? "URDF" : "MJCF";
}

/// Where the change of each joint's zero position goes.
enum class EncoderOffsets {
  folded,    ///< into the origin: the file predicts poses from joint positions as the controller reports them
  separate,  ///< not into the origin: joint positions must have the offsets added first
};

/// The place of one joint before and after: its origin in a URDF; in an MJCF its body's pose, or, where further joints
/// of the same body follow, its own point and axis.
struct OriginChange {
  std::string joint;
  int line = 0;                         ///< of the element that changed, from 1
  Vec3 translation = Vec3::Zero();      ///< [m] new minus old position, in the frame of the parent link
  Vec3 rotation_vector = Vec3::Zero();  ///< [rad] from the old to the new orientation, in the joint's frame
  double offset = 0.0;                  ///< [rad] or [m] to be added to the joint position; 0 where folded
  bool translates = false;              ///< prismatic: the offset is a length
  bool inserted = false;                ///< the joint had no origin
};

struct ModelPatch {
  std::string file;  ///< name of the file that was written
  RobotFileFormat format = RobotFileFormat::urdf;
  EncoderOffsets offsets = EncoderOffsets::folded;
  std::vector<OriginChange> changes;            ///< in the order of the file
  std::vector<NonGeometricDifference> omitted;  ///< what the file's format cannot hold
  double omitted_rms = 0.0, omitted_max = 0.0;  ///< [m] of all of these together, over the measured region
};

}  // namespace kinfer
