// SPDX-License-Identifier: Apache-2.0
// The equations of a reach target: weighted error of the tool, and its rows of the Jacobian.
#pragma once

#include "kinfer/kinematics/forward.hpp"
#include "kinfer/kinematics/reach_target.hpp"

namespace kinfer::motion {

class ReachTask {
 public:
  /// `length`: [m] that weighs as much as 1 rad.
  ReachTask(const ReachTarget& target, const Vec3& tool_axis, double length);

  struct Error {
    Eigen::Matrix<double, 6, 1> weighted = Eigen::Matrix<double, 6, 1>::Zero();  ///< the first rows() [1]
    double position = 0.0;                                                       ///< [m]
    double angle = 0.0;                                                          ///< [rad]
  };

  int rows() const { return rows_; }
  /// Degrees of freedom that the target fixes: the direction of an axis has three rows, but fixes two.
  int fixed_freedoms() const { return freedoms_; }
  Error error(const Pose& tool) const;
  /// Rows of the Jacobian: −d weighted / dq, rows() x dof.
  void rows(const Pose& tool, const Twists& twists, MatrixXd& jacobian) const;

 private:
  ReachTarget target_;
  Vec3 tool_axis_;
  double length_;
  int rows_ = 3, freedoms_ = 3;
};

}  // namespace kinfer::motion
