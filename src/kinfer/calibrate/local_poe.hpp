// The local product of exponentials (Chen, Yang 1999): a chain of joints of which nothing is known but their types,
//   world_T_tool = T_1 exp(q_1) T_2 exp(q_2) … T_n exp(q_n) T_tool,
// each T_i a free frame and each exp a motion about or along its z axis. It has no singular parameters, so least
// squares finds it from generic starts; a DH chain is read off afterwards.
#pragma once

#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// Joint types from words like "6R", "RRPR", "2RP3R". An error for anything else.
Result<std::vector<JointType>> parse_joint_types(const std::string& text);

/// A straight chain with joints J1 … Jn of these types, to read data by.
Chain generic_chain(const std::vector<JointType>& types);

struct LocalPoeFit {
  Chain chain;
  double typical = 0.0;          ///< [m] median error of the points
  int starts = 0, agreeing = 0;  ///< generic starts, and how many of them came to this optimum
};

/// The chain of these joints that explains the points (and orientations) best, from several generic starts. An error
/// where too little is measured, or where no start explains the points to a hundredth of their spread.
Result<LocalPoeFit> fit_local_poe(const std::vector<JointType>& types, const PoseSet& data, int threads, Rng rng);

}  // namespace kinfer
