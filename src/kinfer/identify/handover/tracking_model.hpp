// SPDX-License-Identifier: Apache-2.0
// What a continuous-time fit knows of a machine, in the form that tracking takes.
#pragma once

#include <optional>

#include "kinfer/estimate/continuous/solver/normal_equations.hpp"
#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/identify/geometry/mean_revolute.hpp"
#include "kinfer/identify/handover/parameter_covariance.hpp"
#include "kinfer/identify/handover/tracked_bodies.hpp"

namespace kinfer::identify {

/// A joint of the fit and what was made of it.
struct FittedJoint {
  const JointEstimate& estimate;
  const JointGeometry& geometry;
  JointBodies bodies;
  std::vector<double> zero;                 ///< as for refined_joint
  std::vector<SplineMarginal> at_zero;      ///< of each body, at the time that its zero is stated for
  const std::optional<MeanRevolute>& mean;  ///< of a relaxed joint
};

/// A fit. Its residuals are those of the passband that was fitted.
struct FittedMachine {
  const InsRecording& recording;
  const InsProblem& problem;
  const InsFit& fit;
  const std::vector<InsNoise>&noise, &noise_floor;  ///< of each sensor, at full bandwidth
  const ModelError& error;
  ConstMatrixRef covariance;  ///< parameter_covariance
  std::vector<FittedJoint> joints;
};

TrackingModel tracking_model(const FittedMachine& machine);

}  // namespace kinfer::identify
