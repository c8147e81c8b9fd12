// SPDX-License-Identifier: Apache-2.0
// A chain as moving axes with constant transforms between them: tool pose and Jacobian without allocation, for searches
// that evaluate thousands of postures. Loads, compliance, harmonics and backlash are not part of it.
#pragma once

#include <utility>
#include <vector>

#include "kinfer/kinematics/chain.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer::motion {

class ScrewChain {
 public:
  explicit ScrewChain(const Chain& chain);

  /// Tool pose at one posture, and the axis and origin of every moving joint in the world.
  struct Placement {
    Pose tool;
    std::vector<Vec3> axis, origin;
  };

  int dof() const { return dof_; }

  /// `q`: dof joint positions [rad] or [m].
  void place(const VectorXd& q, Placement& at) const;

  /// Change of the tool by the joint positions, 6 x dof.
  void jacobian(const Placement& at, Twists& twists) const;

  /// Of q[k], after which the tool is back where it was [rad]; 0 where there is none.
  double period(int k) const { return period_[static_cast<std::size_t>(k)]; }
  /// q[k] is an angle.
  bool is_rotational(int k) const { return rotational_[static_cast<std::size_t>(k)]; }

 private:
  struct MovingJoint {
    Pose before;  ///< from the frame after the joint before it; the axis is z
    bool rotates = true;
    std::vector<std::pair<int, double>> terms;  ///< variable = Σ factor · q[index]
  };

  int dof_ = 0;
  Pose base_, tool_;
  std::vector<MovingJoint> joints_;
  std::vector<double> period_;
  std::vector<bool> rotational_;
};

}  // namespace kinfer::motion
