// SPDX-License-Identifier: Apache-2.0
// The three angles of a spherical joint, continuous over time.
#pragma once

#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

/// Angles of R = Rx(q0) Ry(q1) Rz(q2); of the two solutions, unwrapped, the one nearer to `before`.
Vec3 cardan_angles(const Mat3& r, const Vec3& before);

}  // namespace kinfer
