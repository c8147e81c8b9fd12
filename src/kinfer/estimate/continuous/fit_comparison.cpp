// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/fit_comparison.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer {
namespace {

void widen(JointDifference& largest, const Vec3& axis, const Vec3& other_axis, const Vec3& between) {
  largest.angle = std::max(largest.angle, std::atan2(axis.cross(other_axis).norm(), std::abs(axis.dot(other_axis))));
  largest.distance = std::max(largest.distance, axis.cross(between).norm());
}

double number_of_values(const std::vector<InsBlock>& blocks) {
  double rows = 0.0;
  for (const InsBlock& block : blocks) rows += block.rows;
  return 3.0 * rows;
}

}  // namespace

JointDifference largest_difference(const InsBodies& a, const InsBodies& b) {
  JointDifference largest;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].motion != JointMotion::revolute) continue;
    widen(largest, a[i].parent_R_axis.col(2), b[i].parent_R_axis.col(2), b[i].point_in_parent - a[i].point_in_parent);
    widen(largest, a[i].child_R_axis.col(2), b[i].child_R_axis.col(2), b[i].point_in_child - a[i].point_in_child);
  }
  return largest;
}

double negative_log_likelihood(const InsProblem& problem, const InsCost& cost) {
  double sum = cost.total;
  for (const InsMeasurements& sensor : problem.sensors)
    sum += 2.0 * (number_of_values(sensor.angular_velocity) * std::log(sensor.noise.angular_velocity) +
                  number_of_values(sensor.force) * std::log(sensor.noise.force));
  return sum;
}

}  // namespace kinfer
