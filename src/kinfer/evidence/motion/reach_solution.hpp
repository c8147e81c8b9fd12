// SPDX-License-Identifier: Apache-2.0
// Joint positions that bring the tool to a target, or why there are none.
#pragma once

#include <string_view>
#include <vector>

#include "kinfer/linalg/types.hpp"

namespace kinfer {

enum class ReachStatus {
  reached,
  outside_limits,  ///< only postures beyond joint limits reach the target
  near_singular,   ///< the way to the target ends in a singular posture
  out_of_reach,
};
/// As in files: "reached", "outside_limits", "near_singular", "out_of_reach".
std::string_view name(ReachStatus status);

struct Posture {
  VectorXd q{};           ///< joint positions [rad] or [m]
  double distance = 0.0;  ///< from the preferred posture: root sum of squares [rad], lengths divided by the reach
};

struct ReachSolution {
  ReachStatus status = ReachStatus::out_of_reach;
  std::vector<Posture> postures{};  ///< at least one: where the status is not `reached`, the closest inside the limits
  double position_error = 0.0;      ///< [m] left at the first posture
  double angle_error = 0.0;         ///< [rad] left at the first posture, of what the target directs
  std::vector<int>
      limited_joints{};  ///< outside_limits: indices into q, beyond their limits where the target is reached
  int starts_used = 0;
};

struct ReachSummary {
  int targets = 0;
  std::vector<int> unreached{};  ///< indices of targets
  int postures = 0;              ///< of all reached targets
};
ReachSummary summarise(const std::vector<ReachSolution>& solutions);

}  // namespace kinfer
