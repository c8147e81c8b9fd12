// SPDX-License-Identifier: Apache-2.0
#include "peers/naive_eigen.hpp"

#include <Eigen/Core>
#include <cmath>

namespace kinfer::bench {
namespace {

Eigen::Matrix4d link(double a, double alpha, double d, double theta) {
  const double ct = std::cos(theta), st = std::sin(theta), ca = std::cos(alpha), sa = std::sin(alpha);
  Eigen::Matrix4d m;
  // clang-format off
  m << ct,      -st,       0,   a,
       st * ca,  ct * ca, -sa, -d * sa,
       st * sa,  ct * sa,  ca,  d * ca,
       0,        0,        0,   1;
  // clang-format on
  return m;
}

Eigen::Matrix4d tool(const double* x, const double* q) {
  Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
  for (int j = 0; j < 6; ++j) pose = pose * link(x[4 * j], x[4 * j + 1], x[4 * j + 2], x[4 * j + 3] + q[j]);
  return pose;
}

}  // namespace

double naive_sum(const double* x, const double* joints, const double* measured, int n) {
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector3d at = tool(x, joints + 6 * i).topRightCorner<3, 1>();
    sum += (Eigen::Map<const Eigen::Vector3d>(measured + 3 * i) - at).squaredNorm();
  }
  return sum;
}

void naive_position(const double* x, const double* q, double* position) {
  Eigen::Map<Eigen::Vector3d>(position, 3) = tool(x, q).topRightCorner<3, 1>();
}

}  // namespace kinfer::bench
