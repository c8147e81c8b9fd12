// Which poses to measure: those that leave the least error of the tool after calibration, with the tolerances as
// priors.
#pragma once

#include <optional>

#include "kinfer/calibrate/plan_design.hpp"
#include "kinfer/calibrate/plan_space.hpp"
#include "kinfer/evidence/plan.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

enum class Measures { positions, poses };

struct PlanTask {
  Chain nominal;
  Tolerances tolerances{};
  Instrument instrument{.sigma = 5e-5, .sigma_angle = 2e-4};  ///< what one measurement is worth
  Measures measures = Measures::positions;
  PoseSet existing{};     ///< measured already; its poses count, and none near them is chosen
  MatrixXd candidates{};  ///< dof x n to choose from; empty: drawn from the space
  MeasuringSpace space{};
};

struct PlanOptions {
  int poses = 20;
  Criterion criterion = Criterion::tool;
  double spacing = 0.09;  ///< [rad], [m]: chosen poses differ by more than this in some joint; 5°
  int candidates = 1000;  ///< drawn where the task lists none
  int starts = 3;         ///< of the exchange besides the greedy one
  int threads = 0;        ///< 0: all cores; the result does not depend on it
};

/// An error where the space leaves no poses or fewer than two candidates.
Result<PosePlan> plan_poses(const PlanTask& task, const PlanOptions& options, Rng rng);

}  // namespace kinfer
