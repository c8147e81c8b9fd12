// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/fixtures.hpp"

namespace kinfer {

void fold(Plane& plane) {
  plane.rotation *= rot_x(plane.small_rotation.x()) * rot_y(plane.small_rotation.y());
  plane.small_rotation.setZero();
}

void fold(NamedFrame& fixture) {
  fold(fixture.frame);
}

}  // namespace kinfer
