// SPDX-License-Identifier: Apache-2.0
// Reference for accelerations of a DH chain: 4×4 products at three times, differenced. The link kernel is tested and
// benchmarked against it.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "kinfer/identify/programming/dh_leaf.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer::test {
using namespace identify;

inline Eigen::Matrix4d naive_leaf(const DhLeaf& leaf, double q) {
  const double theta = leaf.theta + (leaf.theta_signal == 0 ? q : 0.0);
  const double alpha = leaf.alpha + (leaf.alpha_signal == 0 ? q : 0.0);
  Eigen::Matrix4d about_z = Eigen::Matrix4d::Identity(), about_x = about_z, shift_d = about_z, shift_a = about_z;
  about_z.topLeftCorner<2, 2>() << std::cos(theta), -std::sin(theta), std::sin(theta), std::cos(theta);
  about_x.block<2, 2>(1, 1) << std::cos(alpha), -std::sin(alpha), std::sin(alpha), std::cos(alpha);
  shift_d(2, 3) = leaf.d;
  shift_a(0, 3) = leaf.a;
  return shift_d * about_z * shift_a * about_x;
}

/// Parent poses and joint angles at t − h, t, t + h; the acceleration of the chain's end at t, and its rotation.
struct NaiveSample {
  std::array<Eigen::Matrix4d, 3> parent;
  std::array<double, 3> q;
  Vec3 acceleration;  // measured
  Mat3 rotation;      // measured
};

/// Sum over the samples of the squared difference of accelerations plus half that of rotations.
inline double naive_square(const std::vector<NaiveSample>& samples, const std::vector<DhLeaf>& leaves, double h) {
  double sum = 0.0;
  for (const NaiveSample& s : samples) {
    std::array<Eigen::Matrix4d, 3> pose = s.parent;
    for (std::size_t k = 0; k < 3; ++k)
      for (const DhLeaf& leaf : leaves) pose[k] = pose[k] * naive_leaf(leaf, s.q[k]);
    const Vec3 acceleration =
        (pose[0].topRightCorner<3, 1>() - 2.0 * pose[1].topRightCorner<3, 1>() + pose[2].topRightCorner<3, 1>()) /
        (h * h);
    sum += (acceleration - s.acceleration).squaredNorm() +
           0.5 * (pose[1].topLeftCorner<3, 3>() - s.rotation).squaredNorm();
  }
  return sum;
}

}  // namespace kinfer::test
