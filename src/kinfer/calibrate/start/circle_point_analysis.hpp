// SPDX-License-Identifier: Apache-2.0
// Base and tool from single-joint sweeps (circle point analysis, paper 2, section 2.2): each sweep moves the target on
// a circle, whose normal is the joint's axis.
//
// Base: the two axes of lowest joints that are not parallel have a common perpendicular; its foot on the first axis,
// this axis as z and the perpendicular as x are a frame that the nominal chain knows too (in the paper F1, from which
// F0 follows by d1). So any posture and any such pair of axes will do. Tool: once the base is known, every row gives
// the tool point on the flange; their mean is used. The paper's tool length is reported too: from the radius of a sweep
// of the last joint but one, for a target on the flange's axis (xt = yt = 0).
#pragma once

#include <span>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/deployment/frame_estimate.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::calibrate {

/// Rows in which one joint alone moves.
struct Sweep {
  std::string name;  ///< as marked in the file; empty: found by its rows
  int q_index = 0;
  std::vector<int> rows;
};

/// The sweeps that the `sweep` column marks; without one, all runs of at least five consecutive rows in which one joint
/// alone moves by ten degrees or more. An error where a marked sweep moves several joints.
Result<std::vector<Sweep>> find_sweeps(const PoseSet& data);

/// Circle through the measured tool points of the sweep, with its uncertainty from the scatter about it.
SweepCircle fit_sweep(const Chain& nominal, const PoseSet& data, const Sweep& sweep);

/// `nominal` with base and tool estimated from the sweeps. An error unless two sweeps have axes that are not parallel.
Result<FrameEstimate> estimate_frames_from_circles(const Chain& nominal, const PoseSet& data);

}  // namespace kinfer::calibrate
