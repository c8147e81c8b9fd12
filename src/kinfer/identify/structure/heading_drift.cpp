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

/// The headings of the child relative to the parent's between two gaps, as angles about the vertical at the middles of
/// windows; one window: a constant.
struct HeadingDrift {
  std::vector<std::size_t> rows;  // among those that are evaluated
  double begin = 0.0;             // [s]
  std::vector<double> angle{};    // [rad] of the windows, continuous

  std::size_t window_of(double time) const {
    return std::min(angle.size() - 1, static_cast<std::size_t>((time - begin) / heading_drift_window));
  }
  double at(double time) const {
    const double last = static_cast<double>(angle.size() - 1),
                 along = std::clamp((time - begin) / heading_drift_window - 0.5, 0.0, last);
    const auto before = static_cast<std::size_t>(along), after = std::min(before + 1, angle.size() - 1);
    return std::lerp(angle[before], angle[after], along - static_cast<double>(before));
  }
};

std::vector<double> restarts_of_either(const SegmentMotion& parent, const SegmentMotion& child) {
  std::vector<double> restarts = parent.restarts;
  restarts.insert(restarts.end(), child.restarts.begin(), child.restarts.end());
  std::ranges::sort(restarts);
  return restarts;
}

/// One for each part of the rows between gaps of either sensor: behind a gap a heading is another one.
std::vector<HeadingDrift> headings_between_gaps(const RecordedMotion& motion, const SegmentMotion& parent,
                                                const SegmentMotion& child, const std::vector<std::size_t>& rows) {
  const std::vector<double> restarts = restarts_of_either(parent, child);
  std::vector<HeadingDrift> parts;
  std::size_t gaps = 0, last_gaps = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double time = motion.time[rows[i]];
    while (gaps < restarts.size() && restarts[gaps] <= time) ++gaps;
    if (parts.empty() || gaps != last_gaps) parts.push_back({.rows = {}, .begin = time});
    parts.back().rows.push_back(i);
    last_gaps = gaps;
  }
  for (HeadingDrift& part : parts) {
    const double length = motion.time[rows[part.rows.back()]] - part.begin;
    const auto windows = static_cast<std::size_t>(length / heading_drift_window) + 1;
    part.angle.assign(windows < least_drift_windows ? 1 : windows, 0.0);
  }
  return parts;
}

/// The drift that leaves least of the motion of one axis. A vertical axis tells nothing of it: then it is small.
void fit_drift(HeadingDrift& drift, const MeanAxis& axis, const RecordedMotion& motion, const SegmentMotion& parent,
               const SegmentMotion& child, const std::vector<std::size_t>& rows) {
  std::vector<Vec2> match(drift.angle.size(), Vec2::Zero());  // cosine and sine of the angle, times a weight
  for (const std::size_t i : drift.rows) {
    const std::size_t row = rows[i];
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
  std::vector<HeadingDrift> parts = headings_between_gaps(motion, parent, child, rows);
  if (parts.empty() || (parts.size() == 1 && parts.front().angle.size() == 1)) return rotations;
  for (int pass = 0; pass < heading_drift_passes; ++pass) {
    const MeanAxis axis = mean_axis(rotations);
    for (HeadingDrift& part : parts) {
      fit_drift(part, axis, motion, parent, child, rows);
      for (const std::size_t i : part.rows)
        rotations[i] =
            parent.rotation[rows[i]].transpose() * rot_z(part.at(motion.time[rows[i]])) * child.rotation[rows[i]];
    }
  }
  return rotations;
}

}  // namespace kinfer::identify
