// SPDX-License-Identifier: Apache-2.0
#include "kinfer/geometry/cardan_angles.hpp"

#include <cmath>
#include <numbers>

namespace kinfer {

Vec3 cardan_angles(const Mat3& r, const Vec3& before) {
  constexpr double half_turn = std::numbers::pi, full_turn = 2.0 * half_turn;
  const double cosine = std::hypot(r(0, 0), r(0, 1));
  Vec3 one(before.x(), std::atan2(r(0, 2), cosine), 0.0);
  if (cosine > 1e-9) {
    one.x() = std::atan2(-r(1, 2), r(2, 2));
    one.z() = std::atan2(-r(0, 1), r(0, 0));
  } else {  // gimbal lock: only the sum or difference of the outer angles is observable
    const Mat3 rest = (rot_x(one.x()) * rot_y(one.y())).transpose() * r;
    one.z() = std::atan2(rest(1, 0), rest(0, 0));
  }
  const auto near = [&](Vec3 angles) {
    for (Eigen::Index k = 0; k < 3; ++k) angles[k] += full_turn * std::round((before[k] - angles[k]) / full_turn);
    return angles;
  };
  const Vec3 first = near(one), second = near({one.x() + half_turn, half_turn - one.y(), one.z() + half_turn});
  return (first - before).norm() <= (second - before).norm() ? first : second;
}

}  // namespace kinfer
