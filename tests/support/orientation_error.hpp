// SPDX-License-Identifier: Apache-2.0
// Orientation errors against a reference: total, heading and inclination as defined by the BROAD data set (Laidig,
// Caruso, Cereatti, Seel, Data 6(7), 2021): e = truth ⊗ estimate⁻¹ in world coordinates, split into a rotation about
// the vertical and a tilt.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/square.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::testing {

/// Root mean squares [rad] over the counted rows.
struct OrientationError {
  double total = 0.0, heading = 0.0, inclination = 0.0;
  std::size_t rows = 0;
};

enum class HeadingOffset {
  none,
  best_constant
};  ///< best_constant: without magnetometer the origin of heading is arbitrary

namespace orientation_error_parts {

inline bool usable(const Quat& truth, char is_counted) {
  return is_counted != 0 && truth.coeffs().allFinite();
}

inline double heading_of(const Quat& e) {
  return 2.0 * std::atan2(e.z(), e.w());
}

/// The constant heading that brings the estimate closest to the truth: circular mean, then the mean of the residuals.
inline double best_heading_offset(std::span<const Quat> estimate, std::span<const Quat> truth,
                                  std::span<const char> is_counted) {
  double sine = 0.0, cosine = 0.0, sum = 0.0, n = 0.0;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    if (!usable(truth[i], is_counted[i])) continue;
    const double heading = heading_of(truth[i] * estimate[i].conjugate());
    sine += std::sin(heading), cosine += std::cos(heading);
  }
  const double middle = std::atan2(sine, cosine);
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    if (!usable(truth[i], is_counted[i])) continue;
    sum += std::remainder(heading_of(truth[i] * estimate[i].conjugate()) - middle, 2.0 * std::numbers::pi);
    n += 1.0;
  }
  return n > 0.0 ? middle + sum / n : 0.0;
}

/// Mean rotation: the quaternion that maximises the sum of squared projections (Markley et al. 2007).
inline Quat mean_quaternion(const std::vector<Quat>& rotations) {
  MatrixXd sum = MatrixXd::Zero(4, 4);
  for (const Quat& q : rotations) sum += q.coeffs() * q.coeffs().transpose();
  Quat mean;
  mean.coeffs() = symmetric_eigen(sum).vectors.col(3);
  return mean;
}

/// The 24 rotations of a cube, as starting points over SO(3).
inline std::vector<Quat> cube_rotations() {
  std::vector<Quat> out;
  constexpr double quarter = 0.5 * std::numbers::pi;
  const Quat faces[] = {Quat::Identity(),
                        quat_exp(Vec3(0, quarter, 0)),
                        quat_exp(Vec3(0, 2 * quarter, 0)),
                        quat_exp(Vec3(0, -quarter, 0)),
                        quat_exp(Vec3(quarter, 0, 0)),
                        quat_exp(Vec3(-quarter, 0, 0))};
  for (const Quat& face : faces)
    for (int turn = 0; turn < 4; ++turn) out.push_back(quat_exp(Vec3(0, 0, turn * quarter)) * face);
  return out;
}

inline double rms_angle(std::span<const Quat> estimate, std::span<const Quat> truth, const Quat& left,
                        const Quat& right) {
  double sum = 0.0, n = 0.0;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    if (!usable(truth[i], 1)) continue;
    const Quat e = truth[i] * (left * estimate[i] * right).conjugate();
    sum += square(2.0 * std::atan2(e.vec().norm(), std::abs(e.w())));
    n += 1.0;
  }
  return n > 0.0 ? std::sqrt(sum / n) : 0.0;
}

}  // namespace orientation_error_parts

/// Rows where `is_counted` is 0 or the truth is not finite are skipped.
inline OrientationError orientation_error(std::span<const Quat> estimate, std::span<const Quat> truth,
                                          std::span<const char> is_counted,
                                          HeadingOffset offset = HeadingOffset::none) {
  KINFER_EXPECT(estimate.size() == truth.size() && truth.size() == is_counted.size());
  const double turn =
      offset == HeadingOffset::none ? 0.0 : orientation_error_parts::best_heading_offset(estimate, truth, is_counted);
  const Quat turned = quat_exp(Vec3(0, 0, turn));
  OrientationError error;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    if (!orientation_error_parts::usable(truth[i], is_counted[i])) continue;
    const Quat e = (truth[i] * (turned * estimate[i]).conjugate()).normalized();
    error.total += square(2.0 * std::acos(std::min(1.0, std::abs(e.w()))));
    error.heading += square(2.0 * std::atan2(std::abs(e.z()), std::abs(e.w())));
    error.inclination += square(2.0 * std::acos(std::min(1.0, std::hypot(e.w(), e.z()))));
    ++error.rows;
  }
  const double n = std::max<double>(1.0, static_cast<double>(error.rows));
  error.total = std::sqrt(error.total / n);
  error.heading = std::sqrt(error.heading / n);
  error.inclination = std::sqrt(error.inclination / n);
  return error;
}

/// rms angle [rad] between truth and left · estimate · right with the best-fitting constant rotations, for references
/// with their own world and sensor frames.
inline double aligned_error(std::span<const Quat> estimate, std::span<const Quat> truth) {
  KINFER_EXPECT(estimate.size() == truth.size());
  constexpr std::size_t stride = 10;  // consecutive rows are redundant
  constexpr int rounds = 40;
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < truth.size(); i += stride)
    if (orientation_error_parts::usable(truth[i], 1)) rows.push_back(i);
  double best = std::numbers::pi;
  std::vector<Quat> rotations(rows.size());
  for (Quat right : orientation_error_parts::cube_rotations()) {
    Quat left = Quat::Identity();
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t k = 0; k < rows.size(); ++k)
        rotations[k] = truth[rows[k]] * right.conjugate() * estimate[rows[k]].conjugate();
      left = orientation_error_parts::mean_quaternion(rotations);
      for (std::size_t k = 0; k < rows.size(); ++k)
        rotations[k] = (left * estimate[rows[k]]).conjugate() * truth[rows[k]];
      right = orientation_error_parts::mean_quaternion(rotations);
    }
    best = std::min(best, orientation_error_parts::rms_angle(estimate, truth, left, right));
  }
  return best;
}

}  // namespace kinfer::testing
