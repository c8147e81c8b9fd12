// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/handover/parameter_covariance.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/linalg/products.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

/// Factor on the standard deviation of each parameter.
VectorXd inflation_factors(const InsFit& fit, const InsCovariance& covariance, std::span<const JointBodies> joints) {
  VectorXd factors = covariance.inflation.cwiseMax(1.0).cwiseSqrt();
  const auto share = [&](Index begin, Index size) {
    if (size > 0)
      factors.segment(begin, size)
          .setConstant(std::sqrt(std::max(1.0, covariance.inflation.segment(begin, size).mean())));
  };
  for (const JointBodies& joint : joints)
    share(first_unknown(fit.layout, joint), unknowns_of(fit.layout, fit.unknowns.bodies, joint));
  for (const Index first : fit.layout.error) share(first, fit.layout.errors_each);
  return factors;
}

/// A joint's points, as seen from sensor frames that deflect by `angle` [rad] on their segments.
void add_point_deflection(MatrixXd& covariance, Index begin, const InsBody& spherical, double angle) {
  covariance.diagonal().segment<3>(begin).array() += angle * angle * spherical.point_in_parent.squaredNorm();
  covariance.diagonal().segment<3>(begin + 3).array() += angle * angle * spherical.point_in_child.squaredNorm();
}

/// A joint's axes, likewise: the turns of its first body's frame in the parent and of its last body's in the child.
void add_axis_deflection(MatrixXd& covariance, const InsFit& fit, const JointBodies& joint, double parent,
                         double child) {
  const InsBody &near = fit.unknowns.bodies[joint.first], &far = fit.unknowns.bodies[joint.last];
  if (near.motion != JointMotion::revolute && near.motion != JointMotion::prismatic) return;
  const Index in_parent = std::ranges::count(near.free_parent_rotation, true),
              before_child = std::ranges::count(far.free_parent_rotation, true),
              in_child = std::ranges::count(far.free_child_rotation, true);
  covariance.diagonal().segment(fit.layout.body[joint.first], in_parent).array() += parent * parent;
  covariance.diagonal().segment(fit.layout.body[joint.last] + before_child, in_child).array() += child * child;
}

/// Of all parameters, in alternative models.
MatrixXd stacked_shifts(const InsFit& fit, const ModelError& error) {
  MatrixXd all = MatrixXd::Zero(fit.layout.global_parameters, error.shift.front().cols());
  for (std::size_t b = 0; b < error.shift.size(); ++b)
    all.middleRows(fit.layout.body[b], error.shift[b].rows()) = error.shift[b];
  return all;
}

}  // namespace

bool JointBodies::is_relaxed(const InsBodies& bodies) const {
  return type == EstimatedJointType::revolute && bodies[first].motion == JointMotion::spherical;
}

Index first_unknown(const InsLayout& layout, const JointBodies& joint) {
  return layout.body[joint.first];
}

Index unknowns_of(const InsLayout& layout, const InsBodies& bodies, const JointBodies& joint) {
  return layout.body[joint.last] + bodies[joint.last].unknowns() - first_unknown(layout, joint);
}

double deflection_at(const JointBodies& joint, const ModelError& error, double common) {
  return error.shift.empty()
             ? common
             : std::hypot(common, error.mount_deflection[joint.parent], error.mount_deflection[joint.child]);
}

MatrixXd parameter_covariance(const InsFit& fit, const InsCovariance& covariance, const ModelError& error,
                              std::span<const JointBodies> joints, double common_deflection) {
  const VectorXd factors = inflation_factors(fit, covariance, joints);
  MatrixXd all = factors.asDiagonal() * covariance.model * factors.asDiagonal();
  if (!error.shift.empty()) {
    const MatrixXd shifts = stacked_shifts(fit, error);
    all += times_transposed(shifts, shifts);
  }
  for (const JointBodies& joint : joints) {
    const Index begin = first_unknown(fit.layout, joint);
    const InsBody& near = fit.unknowns.bodies[joint.first];
    if (!error.shift.empty())
      add_axis_deflection(all, fit, joint, error.mount_deflection[joint.parent], error.mount_deflection[joint.child]);
    if (near.motion == JointMotion::spherical)
      add_point_deflection(all, begin, near, deflection_at(joint, error, common_deflection));
  }
  return all;
}

}  // namespace kinfer::identify
