// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/frame.hpp"

namespace kinfer {

Pose Frame::pose() const {
  return {rotation * rot_x(small_rotation.x()) * rot_y(small_rotation.y()) * rot_z(small_rotation.z()), xyz};
}

void fold(Frame& frame) {
  frame = Frame::from_pose(frame.pose());
}

}  // namespace kinfer
