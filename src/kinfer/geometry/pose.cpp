// SPDX-License-Identifier: Apache-2.0
// Not inline: nearly every file includes the header, and would compile Eigen's products again.
#include "kinfer/geometry/pose.hpp"

namespace kinfer {

Pose Pose::operator*(const Pose& next) const {
  return {rotation * next.rotation, rotation * next.position + position};
}

Vec3 Pose::operator*(const Vec3& point) const {
  return rotation * point + position;
}

Pose Pose::inverse() const {
  return {rotation.transpose(), -(rotation.transpose() * position)};
}

}  // namespace kinfer
