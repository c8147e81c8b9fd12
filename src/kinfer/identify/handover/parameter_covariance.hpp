// SPDX-License-Identifier: Apache-2.0
// Covariance of all global parameters of a fit together, with what the residuals and alternative models say about it.
#pragma once

#include <span>

#include "kinfer/estimate/continuous/solver/batch_fit.hpp"
#include "kinfer/estimate/continuous/solver/covariance.hpp"
#include "kinfer/evidence/identification/joint_estimate.hpp"
#include "kinfer/identify/geometry/initial_joint.hpp"

namespace kinfer::identify {

/// Model errors that the covariance from white noise does not contain.
struct ModelError {
  std::vector<MatrixXd> shift;  ///< of each body's unknowns, one column for each alternative model
  std::vector<double>
      mount_deflection;  ///< [rad] rms unexplained deflection of each sensor's mount, beyond its compliance
};

/// A joint in a fit: the bodies that it consists of, and the sensors on both sides.
struct JointBodies {
  EstimatedJointType type = EstimatedJointType::revolute;
  std::size_t first = 0, last = 0;
  std::size_t parent = 0, child = 0;
  std::optional<PositiveAxis> positive_axis{};

  bool is_relaxed(const InsBodies& bodies) const;  ///< a revolute joint that the fit relaxed to a spherical one
};

/// Number of unknowns of a joint's bodies, and the first of them.
Eigen::Index first_unknown(const InsLayout& layout, const JointBodies& joint);
Eigen::Index unknowns_of(const InsLayout& layout, const InsBodies& bodies, const JointBodies& joint);

/// [rad] By which the sensor frames on both sides of a joint deflect on their segments, together. `common`: of all.
double deflection_at(const JointBodies& joint, const ModelError& error, double common);

/// Global parameters x global parameters. The covariance of each joint and each sensor is inflated by the mean of what
/// the sandwich says of its parameters; shifts of alternative models and deflections of the mounts are added.
/// `common_deflection` [rad]: of every mount.
MatrixXd parameter_covariance(const InsFit& fit, const InsCovariance& covariance, const ModelError& error,
                              std::span<const JointBodies> joints, double common_deflection);

}  // namespace kinfer::identify
