// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/fixtures.hpp"

namespace kinfer {

Vec3 Plane::normal() const {
  return rotation * (rot_x(small_rotation.x()) * rot_y(small_rotation.y())).col(2);
}

void fold(Plane& plane) {
  plane.rotation *= rot_x(plane.small_rotation.x()) * rot_y(plane.small_rotation.y());
  plane.small_rotation.setZero();
}

void fold(NamedFrame& fixture) {
  fold(fixture.frame);
}

}  // namespace kinfer
