// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/model/azimuth.hpp"

#include <cmath>

namespace kinfer {
namespace {

using Index = Eigen::Index;

Vec3 part_across(const Vec3& v, const Vec3& axis) {
  return v - axis * axis.dot(v);
}

/// Whether the child's axis shows the azimuth; otherwise its point does.
bool is_shown_by_axis(const Vec3& axis, const InsBody& child) {
  return child.free_parent_rotation[0] && part_across(child.parent_R_axis.col(2), axis).norm() > min_azimuth_lever;
}

}  // namespace

std::vector<InsAzimuth> azimuths_of(const InsBodies& bodies) {
  std::vector<InsAzimuth> all;
  for (std::size_t child = 1; child < bodies.size(); ++child) {
    if (bodies[child].parent < 1) continue;
    const auto body = static_cast<std::size_t>(bodies[child].parent);
    const InsAzimuth azimuth{body, child};
    if (bodies[body].motion == JointMotion::revolute && bodies[body].sensor >= 0 &&
        azimuth_direction(bodies, azimuth).norm() > 0.0)
      all.push_back(azimuth);
  }
  return all;
}

Vec3 azimuth_direction(const InsBodies& bodies, const InsAzimuth& azimuth) {
  const InsBody &body = bodies[azimuth.body], &child = bodies[azimuth.child];
  const Vec3 axis = body.child_R_axis.col(2);
  if (is_shown_by_axis(axis, child)) return part_across(child.parent_R_axis.col(2), axis);
  const Vec3 arm = part_across(child.point_in_parent - body.point_in_child, axis);
  return child.free_point_in_parent && arm.norm() > min_azimuth_lever ? arm : Vec3(Vec3::Zero());
}

double azimuth_from(const Vec3& direction, const InsBodies& bodies, const InsAzimuth& azimuth) {
  const Vec3 axis = bodies[azimuth.body].child_R_axis.col(2), now = azimuth_direction(bodies, azimuth);
  return std::atan2(axis.dot(direction.cross(now)), direction.dot(now));
}

VectorXd azimuth_gradient(const InsLayout& layout, const InsBodies& bodies, const InsAzimuth& azimuth) {
  const InsBody& child = bodies[azimuth.child];
  const Vec3 axis = bodies[azimuth.body].child_R_axis.col(2), direction = azimuth_direction(bodies, azimuth);
  VectorXd gradient = VectorXd::Zero(layout.global_parameters);
  if (!(direction.squaredNorm() > 0.0)) return gradient;
  const Vec3 by_direction = axis.cross(direction) / direction.squaredNorm();
  const Index first = layout.body[azimuth.child];
  if (is_shown_by_axis(axis, child)) {
    gradient[first] = -by_direction.dot(child.parent_R_axis.col(1));
    gradient[first + 1] = by_direction.dot(child.parent_R_axis.col(0));
  } else {
    gradient.segment<3>(first + child.turns()) = by_direction;
  }
  return gradient;
}

void rotate_azimuth(InsBodies& bodies, const InsAzimuth& azimuth, double angle) {
  const InsBody& body = bodies[azimuth.body];
  InsBody& child = bodies[azimuth.child];
  const Mat3 turn = exp_so3(angle * body.child_R_axis.col(2));
  child.parent_R_axis = turn * child.parent_R_axis;
  child.point_in_parent = body.point_in_child + turn * (child.point_in_parent - body.point_in_child);
}

}  // namespace kinfer
