// SPDX-License-Identifier: Apache-2.0
// One descent of the posture search: from a start to a posture that meets the target, and along the null space of a
// redundant chain towards a preferred posture.
#pragma once

#include "kinfer/motion/reach_task.hpp"
#include "kinfer/motion/screw_chain.hpp"

namespace kinfer::motion {

class Descent {
 public:
  struct Steps {
    bool of_machine = false;   ///< with its non-geometric terms; else of the rigid chain
    bool are_clamped = false;  ///< to the limits
    bool are_rough = false;    ///< to thresholds::rough_correction
    bool are_patient = false;  ///< to the end, else left early where the error falls slowly
  };

  /// What one start came to.
  struct Attempt {
    VectorXd q;
    double error = 0.0;  ///< norm of the weighted error [1]
    bool converged = false;
  };

  /// Tolerances of position [m] and angle [rad].
  Descent(const Chain& chain, const Load& load, double position_tolerance, double angle_tolerance);

  const Chain& chain() const { return chain_; }
  const JointLimits& limits() const { return limits_; }
  bool is_inside(const VectorXd& q) const;
  const ScrewChain& screws() const { return screws_; }
  /// [m] Sum of the constant transforms: a bound of how far the tool gets without prismatic joints.
  double length() const { return length_; }
  bool has_non_geometric_terms() const { return deviates_; }

  /// The tool of the machine, non-geometric terms included.
  Pose tool(const VectorXd& q) const { return forward(chain_, q, load_); }

  Attempt run(const ReachTask& task, VectorXd q, Steps kind);

  /// Moves a redundant chain towards the preferred posture, and towards the inside of the limits, without moving the
  /// tool: steps in the null space of the task.
  void approach(const ReachTask& task, const VectorXd& preferred, VectorXd& q);

  /// Removes revolutions: each periodic joint position as near to the preferred one as its limits allow.
  void unwind(VectorXd& q, const VectorXd& preferred) const;

  /// [rad] Root sum of squares of the differences, those of lengths divided by length().
  double distance(const VectorXd& q, const VectorXd& preferred) const;

 private:
  bool is_met(const ReachTask::Error& error) const;
  bool is_met_but_for_rounding(const ReachTask& task, const ReachTask::Error& error) const;
  void set_units(double position_error);
  void set_rows(const ReachTask& task);
  void leave_out_limited(const ReachTask& task, const VectorXd& q, const ReachTask::Error& error);
  VectorXd null_space_step(const ReachTask& task, const VectorXd& wanted);
  bool set_step(const ReachTask& task, const Eigen::Matrix<double, 6, 1>& error, double damping);

  Chain chain_;
  Load load_;
  ScrewChain screws_;
  JointLimits limits_;
  double length_;
  bool deviates_;
  double position_tolerance_, angle_tolerance_;
  // Buffers of the inner loop.
  ScrewChain::Placement at_;
  Twists twists_;
  MatrixXd rows_, normal_;
  VectorXd right_, step_;
  VectorXd unit_;  ///< of each joint's steps: 1 rad, or what counts as much of a joint that translates [m]
};

}  // namespace kinfer::motion
