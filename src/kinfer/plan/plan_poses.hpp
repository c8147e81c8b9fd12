// SPDX-License-Identifier: Apache-2.0
// Pose planning: the poses to measure so that the expected tool error after calibration is least, with the tolerances
// as priors.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/evidence/deployment/pose_plan.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/kinematics/poses/pose_constraints.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::plan {

enum class Measures { positions, poses };

struct PlanTask {
  Chain nominal;
  Tolerances tolerances{};
  Instrument instrument{.sigma = 5e-5, .sigma_angle = 2e-4};  ///< accuracy of one measurement
  Measures measures = Measures::positions;
  PoseSet existing{};       ///< measured already: counts as prior information
  MatrixXd candidates{};    ///< dof x n to choose from; empty: drawn from the space
  PoseConstraints space{};  ///< of poses that are drawn; not of `candidates`
};

/// This accuracy, or that of a PlanTask where it states no lengths or no angles.
Instrument planned_instrument(Instrument stated);

struct PlanOptions {
  int poses = 20;
  Criterion criterion = Criterion::tool;
  double spacing = 0.09;  ///< [rad], [m]: chosen poses differ by more than this in some joint; 5°
  int candidates = 1000;  ///< drawn where the task lists none
  int starts = 3;         ///< random starts of the exchange, besides the greedy one
  int threads = 0;        ///< 0: all cores; the result does not depend on it
};

/// An error if no pose is feasible, or if there are fewer than two candidates.
Result<PosePlan> plan_poses(const PlanTask& task, const PlanOptions& options, Rng rng);

}  // namespace kinfer::plan
