// SPDX-License-Identifier: Apache-2.0
#include "studies/track/relative_orientation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/geometry/fit.hpp"

namespace kinfer::study::track_study {
namespace {

constexpr int alternations = 20;
constexpr std::size_t far = 15;  // frames between the orientations whose difference is a rotation

/// Rotation nearest to Σ aᵢ bᵢᵀ, so that aᵢ ≈ result · bᵢ.
Mat3 mean_rotation(const std::vector<Mat3>& a, const std::vector<Mat3>& b) {
  std::vector<Vec3> to, from;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int k = 0; k < 3; ++k)
      for (const double sign : {1.0, -1.0}) {  // so that both centroids are the origin
        to.emplace_back(sign * a[i].col(k));
        from.emplace_back(sign * b[i].col(k));
      }
  return align_points(to, from).rotation;
}

/// Y of X estimate Y ≈ reference, from rotations between frames that lie apart: Yᵀ (Eᵢᵀ Eⱼ) Y ≈ Rᵢᵀ Rⱼ.
Mat3 first_child_rotation(const std::vector<Mat3>& estimate, const std::vector<Mat3>& reference) {
  std::vector<Vec3> of_estimate, of_reference;
  for (std::size_t i = 0; i + far < estimate.size(); ++i)
    for (const double sign : {1.0, -1.0}) {
      of_estimate.emplace_back(sign * log_so3(estimate[i].transpose() * estimate[i + far]));
      of_reference.emplace_back(sign * log_so3(reference[i].transpose() * reference[i + far]));
    }
  return align_points(of_estimate, of_reference).rotation;
}

}  // namespace

Mat3 at(const RelativeOrientation& motion, double time) {
  const Mat3 unknown = Mat3::Constant(std::numeric_limits<double>::quiet_NaN());
  const auto next = std::ranges::lower_bound(motion.time, time);
  if (next == motion.time.begin() || next == motion.time.end()) return unknown;
  const auto i = static_cast<std::size_t>(next - motion.time.begin());
  const Mat3 &a = motion.rotation[i - 1], &b = motion.rotation[i];
  if (!a.allFinite() || !b.allFinite()) return unknown;
  const double share = (time - motion.time[i - 1]) / (motion.time[i] - motion.time[i - 1]);
  return a * exp_so3(share * log_so3(a.transpose() * b));
}

double rms_difference(const RelativeOrientation& estimate, const RelativeOrientation& reference, double begin,
                      double end) {
  std::vector<Mat3> e, r;
  for (std::size_t i = 0; i < reference.time.size(); ++i) {
    if (reference.time[i] < begin || reference.time[i] > end || !reference.rotation[i].allFinite()) continue;
    const Mat3 estimated = at(estimate, reference.time[i]);
    if (!estimated.allFinite()) continue;
    e.push_back(estimated);
    r.push_back(reference.rotation[i]);
  }
  if (e.size() <= far) return std::numeric_limits<double>::quiet_NaN();
  Mat3 x, y = first_child_rotation(e, r);
  std::vector<Mat3> left(e.size()), right(e.size());
  for (int k = 0; k < alternations; ++k) {
    for (std::size_t i = 0; i < e.size(); ++i) left[i] = e[i] * y;
    x = mean_rotation(r, left);
    for (std::size_t i = 0; i < e.size(); ++i) {
      left[i] = (x * e[i]).transpose();
      right[i] = r[i].transpose();
    }
    y = mean_rotation(right, left).transpose();
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < e.size(); ++i) sum += log_so3(r[i].transpose() * x * e[i] * y).squaredNorm();
  return std::sqrt(sum / static_cast<double>(e.size()));
}

}  // namespace kinfer::study::track_study
