// SPDX-License-Identifier: Apache-2.0
// Plot data of a calibration: the chains, the poses with their errors, and the predicted error over the workspace.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/kinematics/chain.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// One measured row. `error_*` is predicted minus measured, in the world frame [m]; none where no point was measured.
struct PlotRow {
  std::optional<Vec3> measured{};                     ///< [m] first measured point of the row, in the world frame
  std::optional<Vec3> error_before{}, error_after{};  ///< nominal chain with base and tool refitted; final chain
  double predicted = 0.0;                             ///< [m] rms tool error that is expected, with model error
};

/// A tool position and the uncertainty of the corrected model there.
struct WorkspacePoint {
  Vec3 tool = Vec3::Zero();  ///< [m] in the world frame
  double predicted = 0.0;    ///< [m] rms tool error that is expected, with model error
  VectorXd joints{};         ///< dof, [rad] or [m]: joint positions that put the tool there
};

struct CalibrationPlotData {
  Chain nominal{};                          ///< as given
  Chain before{};                           ///< base and tool refitted
  MatrixXd joints{};                        ///< dof x rows, [rad] or [m]
  std::vector<PlotRow> rows{};              ///< one per row of the data
  std::vector<WorkspacePoint> workspace{};  ///< joint positions evenly distributed over the ranges of the data
};

}  // namespace kinfer
