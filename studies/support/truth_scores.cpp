// SPDX-License-Identifier: Apache-2.0
#include "studies/support/truth_scores.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/support/truth_geometry.hpp"

namespace kinfer::study {
namespace {

struct Scorer {
  GeometryScore& score;

  /// Axis and point in one sensor's frame, with the two directions that the standard deviations belong to.
  void side(const std::string& label, Vec3 axis, const Vec3& point, const Vec3& true_axis, const Vec3& true_point,
            const std::vector<Vec3>& unobservable, const std::array<double, 2>& axis_sd,
            const std::array<double, 2>& point_sd) {
    if (axis.dot(true_axis) < 0.0) axis = -axis;
    const Vec3 x = any_perpendicular(axis).normalized(), y = axis.cross(x);
    const Vec3 axis_error = axis - true_axis;
    score.direction = std::max(score.direction, axis_angle(axis, true_axis));
    score.scalars.push_back({label + " axis x", x.dot(axis_error), axis_sd[0]});
    score.scalars.push_back({label + " axis y", y.dot(axis_error), axis_sd[1]});
    const auto basis = unobservable_basis(true_axis, unobservable);
    const Vec3 error = orthogonal_part(point - true_point, basis);
    score.line = std::max(score.line, error.norm());
    if (basis.size() > 1) return;  // no standard deviation is stated for the remaining directions
    score.scalars.push_back({label + " point x", x.dot(error), point_sd[0]});
    score.scalars.push_back({label + " point y", y.dot(error), point_sd[1]});
  }
};

}  // namespace

GeometryScore geometry_score(const std::vector<JointEstimate>& estimates, const MachineTruth& truth) {
  GeometryScore score;
  Scorer scorer{score};
  for (const JointTruth& t : truth.joints) {
    const auto joint = std::ranges::find_if(
        estimates, [&](const JointEstimate& f) { return f.parent == t.parent && f.child == t.child; });
    if (joint == estimates.end()) {
      score.complete = false;
      score.line = score.direction = 1e3;
      continue;
    }
    if (t.type != JointType::revolute) continue;
    const AlignedJoint aligned = align_azimuth(*joint, t, truth);
    score.azimuth = std::max(score.azimuth, std::abs(aligned.azimuth));
    const std::string label = t.name;
    const auto before = score.scalars.size();
    scorer.side(label + " parent", aligned.axis, aligned.point, t.axis_in_parent, t.point_in_parent,
                t.unobservable_in_parent, joint->sd.axis_in_parent, joint->sd.point_in_parent);
    if (aligned.azimuth_is_free) score.scalars.resize(before);  // their sd contain the azimuth's
    const auto middle = score.scalars.size();
    scorer.side(label + " child", joint->axis_in_child, joint->point_in_child, t.axis_in_child, t.point_in_child,
                t.unobservable_in_child, joint->sd.axis_in_child, joint->sd.point_in_child);
    if (t.heading_needs_magnetometer) score.scalars.resize(std::min(score.scalars.size(), middle + 2));
    if (t.is_axial_offset_observable && t.unobservable_in_parent.empty()) {
      const double sign = joint->axis_in_parent.dot(t.axis_in_parent) < 0.0 ? -1.0 : 1.0;
      const auto offset = [&](const Vec3& ap, const Vec3& p, const Vec3& ac, const Vec3& c) {
        return ap.dot(p) - ac.dot(c);
      };
      const double estimated =
          sign * offset(joint->axis_in_parent, joint->point_in_parent, joint->axis_in_child, joint->point_in_child);
      const double expected = offset(t.axis_in_parent, t.point_in_parent, t.axis_in_child, t.point_in_child);
      score.axial_offset = std::max(score.axial_offset, std::abs(estimated - expected));
      score.scalars.push_back({label + " axial offset", estimated - expected, joint->sd.along_axis});
    }
  }
  return score;
}

}  // namespace kinfer::study
