// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/heading_drift.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/identify/structure/thresholds.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

using Vec2 = Eigen::Vector2d;

/// Unit vectors that a mean rotation maps onto each other best, in child and parent.
struct MeanAxis {
  Vec3 in_child, in_parent;
};

MeanAxis mean_axis(const std::vector<Mat3>& rotations) {
  Mat3 sum = Mat3::Zero();
  for (const Mat3& rotation : rotations) sum += rotation;
  const Vec3 in_child = symmetric_eigen(sum.transpose() * sum).vectors.col(2);
  return {in_child, (sum * in_child).normalized()};
}

/// The headings of the child relative to the parent's, as angles about the vertical at the middles of windows.
struct HeadingDrift {
  double begin = 0.0;         // [s]
  std::vector<double> angle;  // [rad] of the windows, continuous

  std::size_t window_of(double time) const { return static_cast<std::size_t>((time - begin) / heading_drift_window); }
  double at(double time) const {
    const double last = static_cast<double>(angle.size() - 1),
                 along = std::clamp((time - begin) / heading_drift_window - 0.5, 0.0, last);
    const auto before = static_cast<std::size_t>(along), after = std::min(before + 1, angle.size() - 1);
    return std::lerp(angle[before], angle[after], along - static_cast<double>(before));
  }
};

/// The drift that leaves least of the motion of one axis. A vertical axis tells nothing of it: then it is small.
void fit_drift(HeadingDrift& drift, const MeanAxis& axis, const RecordedMotion& motion, const SegmentMotion& parent,
               const SegmentMotion& child, const std::vector<std::size_t>& rows) {
  std::vector<Vec2> match(drift.angle.size(), Vec2::Zero());  // cosine and sine of the angle, times a weight
  for (const std::size_t row : rows) {
    const Vec3 of_parent = parent.rotation[row] * axis.in_parent, of_child = child.rotation[row] * axis.in_child;
    match[drift.window_of(motion.time[row])] +=
        Vec2(of_child.head<2>().dot(of_parent.head<2>()) + weight_of_no_drift, of_child.cross(of_parent).z());
  }
  double before = 0.0;
  for (std::size_t w = 0; w < match.size(); ++w) {
    if (match[w].norm() > 0.0) before += wrap_to_pi(std::atan2(match[w].y(), match[w].x()) - before);
    drift.angle[w] = before;
  }
}

}  // namespace

std::vector<Mat3> without_heading_drift(const RecordedMotion& motion, const SegmentMotion& parent,
                                        const SegmentMotion& child, const std::vector<std::size_t>& rows,
                                        std::vector<Mat3> rotations) {
  if (rows.empty()) return rotations;
  HeadingDrift drift{motion.time[rows.front()], {}};
  drift.angle.resize(drift.window_of(motion.time[rows.back()]) + 1);
  if (drift.angle.size() < least_drift_windows) return rotations;
  for (int pass = 0; pass < heading_drift_passes; ++pass) {
    fit_drift(drift, mean_axis(rotations), motion, parent, child, rows);
    for (std::size_t i = 0; i < rows.size(); ++i)
      rotations[i] =
          parent.rotation[rows[i]].transpose() * rot_z(drift.at(motion.time[rows[i]])) * child.rotation[rows[i]];
  }
  return rotations;
}

}  // namespace kinfer::identify
