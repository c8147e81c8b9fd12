// SPDX-License-Identifier: Apache-2.0
// Compiles a chain and its free parameters into the plain structs of the pose kernel.
#pragma once

#include <vector>

#include "kinfer/kinematics/batch/pose_job.hpp"
#include "kinfer/kinematics/parameters.hpp"

namespace kinfer::batch {

/// Places of the numbers of an item: joint positions first, then what the chain has a use for.
struct ItemLayout {
  int dof = 0, stride = 0;
  int torques = -1, approach = -1;  // one per active joint
  int gravity = -1;                 // one per joint
  int rise = -1, payload = -1;

  int append(int numbers) {
    const int first = stride;
    stride += numbers;
    return first;
  }
};

struct PosePlan {
  ItemLayout layout;
  std::vector<DisplacementTerm> terms;
  std::vector<JointDisplacement> joints;
  std::vector<std::vector<double>> coefficients;  // of sums of harmonics, which `joints` point to
  std::vector<Wave> waves;
  std::vector<LoadedJoint> loaded;  // all joints; used where gravity turns joints
  std::vector<CarriedMass> masses;
  std::vector<PoseColumn> columns;  // in the order of the free parameters
  std::vector<double> constants;    // 3 x 4, row by row, each
  std::vector<PoseStep> pose_steps, recorded_steps;
};

PosePlan pose_plan_of(const Chain& chain, const ParameterSet& set);

/// [R t], row by row: 12 numbers.
void write_rows(const Pose& pose, double* to);

}  // namespace kinfer::batch
