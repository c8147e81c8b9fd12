// SPDX-License-Identifier: Apache-2.0
#include "studies/identify/truth_scores.hpp"

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
            const std::vector<Vec3>& hidden, const std::array<double, 2>& axis_sd,
            const std::array<double, 2>& point_sd) {
    if (axis.dot(true_axis) < 0.0) axis = -axis;
    const Vec3 x = any_perpendicular(axis).normalized(), y = axis.cross(x);
    const Vec3 axis_error = axis - true_axis;
    score.direction = std::max(score.direction, axis_angle(axis, true_axis));
    score.scalars.push_back({label + " axis x", x.dot(axis_error), axis_sd[0]});
    score.scalars.push_back({label + " axis y", y.dot(axis_error), axis_sd[1]});
    const auto basis = unknowable(true_axis, hidden);
    const Vec3 error = across(point - true_point, basis);
    score.line = std::max(score.line, error.norm());
    if (basis.size() > 1) return;  // the directions left are none that a standard deviation was stated for
    score.scalars.push_back({label + " point x", x.dot(error), point_sd[0]});
    score.scalars.push_back({label + " point y", y.dot(error), point_sd[1]});
  }
};

}  // namespace

GeometryScore geometry_score(const std::vector<JointEstimate>& found, const MachineTruth& truth) {
  GeometryScore score;
  Scorer scorer{score};
  for (const JointTruth& t : truth.joints) {
    const auto joint =
        std::ranges::find_if(found, [&](const JointEstimate& f) { return f.parent == t.parent && f.child == t.child; });
    if (joint == found.end()) {
      score.complete = false;
      score.line = score.direction = 1e3;
      continue;
    }
    if (t.type != JointType::revolute) continue;
    Vec3 axis = joint->axis_in_parent, point = joint->point_in_parent;
    const auto incoming = std::ranges::find(truth.joints, t.parent, &JointTruth::child);
    const bool loose_azimuth = incoming != truth.joints.end() && t.unobservable_in_parent.size() == 1;
    if (loose_azimuth) {
      const double turn = best_turn(*incoming, t, *joint);
      const Mat3 r = exp_so3(turn * incoming->axis_in_child);
      axis = r * axis;
      point = incoming->point_in_child + r * (point - incoming->point_in_child);
      score.azimuth = std::max(score.azimuth, std::abs(turn));
    }
    const std::string label = t.name;
    const auto before = score.scalars.size();
    scorer.side(label + " parent", axis, point, t.axis_in_parent, t.point_in_parent, t.unobservable_in_parent,
                joint->sd.axis_in_parent, joint->sd.point_in_parent);
    if (loose_azimuth) score.scalars.resize(before);  // stated with the azimuth's part in it
    const bool child_loose = t.heading_needs_magnetometer;
    const auto middle = score.scalars.size();
    scorer.side(label + " child", joint->axis_in_child, joint->point_in_child, t.axis_in_child, t.point_in_child,
                t.unobservable_in_child, joint->sd.axis_in_child, joint->sd.point_in_child);
    if (child_loose) score.scalars.resize(std::min(score.scalars.size(), middle + 2));
    if (t.is_axial_offset_observable && t.unobservable_in_parent.empty()) {
      const double sign = joint->axis_in_parent.dot(t.axis_in_parent) < 0.0 ? -1.0 : 1.0;
      const auto slide = [&](const Vec3& ap, const Vec3& p, const Vec3& ac, const Vec3& c) {
        return ap.dot(p) - ac.dot(c);
      };
      const double is =
          sign * slide(joint->axis_in_parent, joint->point_in_parent, joint->axis_in_child, joint->point_in_child);
      const double ought = slide(t.axis_in_parent, t.point_in_parent, t.axis_in_child, t.point_in_child);
      score.slide = std::max(score.slide, std::abs(is - ought));
      score.scalars.push_back({label + " slide", is - ought, joint->sd.along_axis});
    }
  }
  return score;
}

}  // namespace kinfer::study
