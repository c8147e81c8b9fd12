// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/findings/forecast.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/evidence/identification/unobservable_limit.hpp"
#include "kinfer/identify/findings/thresholds.hpp"

namespace kinfer::identify {
namespace {

constexpr double factor_95_percent = 1.96;  // of a standard deviation

constexpr double unknown = std::numeric_limits<double>::infinity();

/// The two directions across an axis combined, without the unobservable ones.
double sd_across_axis(const std::array<double, 2>& sd) {
  return std::hypot(sd[0] < unobservable_sd ? sd[0] : 0.0, sd[1] < unobservable_sd ? sd[1] : 0.0);
}

/// Of an axis line: what is not known in one direction across the axis is not known at all, however well the other one
/// is. A line that is known worse must not count as known better.
double line_sd(const std::array<double, 2>& point_sd) {
  const double both = std::hypot(point_sd[0], point_sd[1]);
  return both < unobservable_sd ? both : unknown;
}

/// By the child, and by the parent where it rotates, too; a child that never rotates tells nothing of its own point.
double line_sd(const JointEstimate& joint) {
  if (joint.unobservable_in_child.size() >= 3) return line_sd(joint.sd.point_in_parent);
  const double in_child = line_sd(joint.sd.point_in_child);
  return joint.unobservable_in_parent.empty() ? std::max(in_child, line_sd(joint.sd.point_in_parent)) : in_child;
}

void set_azimuth(JointForecast& f, const JointEstimate& joint, const AccuracyTarget& target) {
  f.azimuth_of = joint.parent;
  f.azimuth_sd = std::hypot(joint.sd.axis_in_parent[0], joint.sd.axis_in_parent[1]);
  f.azimuth_is_uncertain = factor_95_percent * f.azimuth_sd > target.direction;
  f.azimuth_is_unobservable = !(f.azimuth_sd < unobservable_sd);
}

JointForecast forecast_joint(const JointEstimate& joint, const AccuracyTarget& target) {
  JointForecast f{.joint = joint_name(joint)};
  f.line_sd = line_sd(joint);
  f.direction_sd = sd_across_axis(joint.sd.axis_in_child);
  if (joint.unobservable_in_parent.empty()) {
    f.direction_sd = std::max(f.direction_sd, sd_across_axis(joint.sd.axis_in_parent));
  } else {
    set_azimuth(f, joint, target);
  }
  if (!is_line_known(joint)) f.line_sd = unknown;
  if (!is_direction_known(joint)) f.direction_sd = unknown;
  f.acceleration_factor =
      std::max(factor_95_percent * f.line_sd / target.line, factor_95_percent * f.direction_sd / target.direction);
  f.time_factor = f.acceleration_factor * f.acceleration_factor;
  f.is_sufficient = f.acceleration_factor <= 1.0;
  f.more_excitation_suffices = f.acceleration_factor <= max_excitation_factor;
  return f;
}

}  // namespace

std::vector<JointForecast> forecast(const std::vector<JointEstimate>& joints, const AccuracyTarget& target) {
  std::vector<JointForecast> all;
  for (const JointEstimate& joint : joints)
    if (joint.type != EstimatedJointType::rigid) all.push_back(forecast_joint(joint, target));
  return all;
}

}  // namespace kinfer::identify
