// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/joints/azimuth_arc.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/evidence/identification/unobservable_limit.hpp"
#include "kinfer/identify/refinement/fits/thresholds.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

/// Second moments of a place on the unit circle about the most likely one, towards the centre and along the tangent.
struct CircleMoments {
  double radial = 0.0, tangential = 0.0;
};
constexpr CircleMoments uniform_circle{1.5, 0.5};

/// E (1 − cos)² and, as the covariance states it, the variance of the angle.
CircleMoments normal_arc(double sd) {
  const double variance = sd * sd;
  return {1.0 - 2.0 * std::exp(-0.5 * variance) + 0.5 * (1.0 + std::exp(-2.0 * variance)), variance};
}

Vec3 part_across(const Vec3& v, const Vec3& axis) {
  return v - axis * axis.dot(v);
}

/// Unknowns of a body when its axis and its point in the parent change.
VectorXd unknowns_for(const InsBody& body, const Vec3& axis_change, const Vec3& point_change) {
  VectorXd change = VectorXd::Zero(body.unknowns());
  if (body.free_parent_rotation[0]) {
    change[0] = -axis_change.dot(body.parent_R_axis.col(1));
    change[1] = axis_change.dot(body.parent_R_axis.col(0));
  }
  if (body.free_point_in_parent) change.segment<3>(body.turns()) = point_change;
  return change;
}

/// [rad] By which the point turns about the axis. Where nothing tells the azimuth, axis and point turn by the same
/// angle; a point that is known better than the axis turns less.
double point_turn_sd(ConstMatrixRef covariance, Index first_of_body, const InsBody& body, const Vec3& tangent,
                     const Vec3& lever_change) {
  const Index size = body.unknowns();
  VectorXd gradient = VectorXd::Zero(size);
  gradient.segment<3>(body.turns()) = tangent;
  if (body.free_parent_rotation[0]) {
    gradient[0] = lever_change.dot(body.parent_R_axis.col(1));
    gradient[1] = -lever_change.dot(body.parent_R_axis.col(0));
  }
  return std::sqrt(std::max(0.0, gradient.dot(covariance.block(first_of_body, first_of_body, size, size) * gradient)));
}

}  // namespace

bool is_open(const AzimuthArc& arc) {
  return arc.azimuth_sd > max_azimuth_prior_sd;
}

bool is_point_lost(const AzimuthArc& arc) {
  return is_open(arc) && std::sqrt(uniform_circle.radial) * arc.radius > unobservable_sd;
}

std::optional<AzimuthArc> azimuth_arc(const InsLayout& layout, const InsBodies& bodies, ConstMatrixRef covariance,
                                      std::size_t child) {
  const std::vector<InsAzimuth> all = azimuths_of(bodies);
  const auto azimuth = std::ranges::find(all, child, &InsAzimuth::child);
  if (azimuth == all.end()) return std::nullopt;
  const InsBody &body = bodies[azimuth->body], &joint = bodies[child];
  const Vec3 about = body.child_R_axis.col(2), axis = joint.parent_R_axis.col(2);
  const double along =
      joint.motion == JointMotion::revolute ? joint.child_R_axis.col(2).dot(joint.point_in_child) : 0.0;
  const Vec3 axis_arm = part_across(axis, about),
             point_arm = part_across(joint.point_in_parent - body.point_in_child, about),
             reported_arm = point_arm - along * axis_arm;
  AzimuthArc arc{.radius = reported_arm.norm(), .beyond_tangent = {}};
  const VectorXd gradient = azimuth_gradient(layout, bodies, *azimuth);
  arc.azimuth_sd = std::sqrt(std::max(0.0, gradient.dot(covariance * gradient)));
  if (joint.free_point_in_parent && arc.radius > min_azimuth_lever) {
    const Vec3 tangent = about.cross(reported_arm) / reported_arm.squaredNorm();
    arc.azimuth_sd =
        std::min(arc.azimuth_sd, point_turn_sd(covariance, layout.body[child], joint, tangent, along * tangent));
  }
  const CircleMoments stated = normal_arc(arc.azimuth_sd), meant = is_open(arc) ? uniform_circle : stated;
  const VectorXd radial = unknowns_for(joint, axis_arm, point_arm),
                 tangential = unknowns_for(joint, about.cross(axis_arm), about.cross(point_arm));
  arc.beyond_tangent = meant.radial * radial * radial.transpose() +
                       std::max(0.0, meant.tangential - stated.tangential) * tangential * tangential.transpose();
  return arc;
}

}  // namespace kinfer::identify
