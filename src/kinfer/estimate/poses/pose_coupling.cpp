// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/pose_coupling.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

/// Index of the tool point measured at each row; −1: none.
std::vector<int> point_of_rows(const PoseSet& data) {
  std::vector<int> point(data.rows(), -1);
  for (std::size_t i = 0; i < data.points.size(); ++i)
    if (data.points[i].target < 0) point[data.points[i].row] = static_cast<int>(i);
  return point;
}

}  // namespace

double PoseCoupling::log_determinant() const {
  return -2.0 * own.diagonal().array().log().sum();
}

std::vector<PoseCoupling> couplings_of(const PoseSet& data, const std::vector<Vec3>& point_sd,
                                       const std::vector<Vec3>& orientation_sd) {
  std::vector<PoseCoupling> couplings;
  const auto coupled = [](const OrientationMeasurement& m) { return m.covariance_with_point.has_value(); };
  if (std::none_of(data.orientations.begin(), data.orientations.end(), coupled)) return couplings;
  const std::vector<int> point_of = point_of_rows(data);
  for (std::size_t i = 0; i < data.orientations.size(); ++i) {
    const OrientationMeasurement& measured = data.orientations[i];
    const int point = point_of[measured.row];
    if (!measured.covariance_with_point || point < 0) continue;
    const Mat3 y = correlation(point_sd[point], data.points[point].axes, orientation_sd[i], measured);
    const auto lower = cholesky(Mat3::Identity() - y.transpose() * y);
    KINFER_EXPECT(lower.has_value(), "the covariance of the pose in row {} is not positive definite", measured.row);
    const Mat3 own = Mat3(*lower).triangularView<Eigen::Lower>().solve(Mat3::Identity());
    couplings.push_back({static_cast<int>(i), point, own, -own * y.transpose()});
  }
  return couplings;
}

ConditionalError condition_on(const ConditionalError& known, const ConditionalError& error,
                              const Mat3& cross_covariance) {
  const auto inverse = invert_spd(known.covariance);
  KINFER_EXPECT(inverse.has_value(), "a covariance that is not positive definite");
  const Mat3 gain = cross_covariance * *inverse;
  return {error.error - gain * known.error, error.covariance - gain * cross_covariance.transpose()};
}

}  // namespace kinfer
