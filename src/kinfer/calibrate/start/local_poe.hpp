// SPDX-License-Identifier: Apache-2.0
// Local product of exponentials (Chen, Yang 1999): a chain of which nothing is known but its joint types,
//   world_T_tool = T_1 exp(q_1) T_2 exp(q_2) … T_n exp(q_n) T_tool,
// each T_i a free frame and each exp a motion about or along its z axis. It has no parameter singularities, so least
// squares converges from random starts; a DH chain is extracted afterwards.
#pragma once

#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::calibrate {

/// Joint types from words like "6R", "RRPR", "2RP3R". An error for anything else.
Result<std::vector<JointType>> parse_joint_types(const std::string& text);

/// A serial chain with joints J1 … Jn of these types, to read pose sets with.
Chain make_serial_chain(const std::vector<JointType>& types);

struct LocalPoeFit {
  Chain chain;
  double median_error = 0.0;     ///< [m] median error of the points
  int starts = 0, agreeing = 0;  ///< random starts, and how many of them converged to this optimum
};

/// The chain of these joint types that best fits the points (and orientations), from several random starts. An error if
/// there are too few measurements, or if no start fits the points to a hundredth of their spread.
Result<LocalPoeFit> fit_local_poe(const std::vector<JointType>& types, const PoseSet& data, int threads, Rng rng);

}  // namespace kinfer::calibrate
