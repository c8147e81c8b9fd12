// What is needed to draw a calibration: the chains, the poses, how far off each was, and how sure the model is where.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/kinematics/chain.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// One measured row. `off` is predicted minus measured, in the world [m]; none where no point of the row was measured.
struct PictureRow {
  std::optional<Vec3> measured{};                 ///< [m] first point that was measured in the row, in the world
  std::optional<Vec3> off_before{}, off_after{};  ///< nominal chain with base and tool refitted; final chain
  double predicted = 0.0;                         ///< [m] rms error of the tool that the covariance expects
};

/// A place of the tool and how uncertain the corrected model is there.
struct WorkspacePoint {
  Vec3 tool = Vec3::Zero();  ///< [m] in the world
  double predicted = 0.0;    ///< [m] rms error that the covariance expects
  VectorXd joints{};         ///< dof, [rad] or [m]: what puts the tool there
};

struct CalibrationPicture {
  Chain nominal{};                          ///< as given
  Chain before{};                           ///< base and tool refitted
  MatrixXd joints{};                        ///< dof x rows, [rad] or [m]
  std::vector<PictureRow> rows{};           ///< one a row of the data
  std::vector<WorkspacePoint> workspace{};  ///< joints spread evenly over the ranges that the data span
};

}  // namespace kinfer
