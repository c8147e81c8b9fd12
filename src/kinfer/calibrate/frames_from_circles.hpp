// Base and tool from single-joint sweeps, paper 2, section 2.2: each sweep moves the target on a circle, whose normal
// is the joint's axis.
//
// Base: the two axes of lowest joints that are not parallel have a common perpendicular; its foot on the first axis,
// this axis as z and the perpendicular as x are a frame that the nominal chain knows too (in the paper F1, from which
// F0 follows by d1). So any posture and any pair of axes will do. Tool: once the base is known, every row says where
// the tool point is on the flange; their mean is taken. The paper's length beside it: the radius of a sweep of the last
// joint but one, for a target on the flange's axis (xt = yt = 0).
#pragma once

#include <span>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/frames.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// Rows in which one joint alone moves.
struct Sweep {
  std::string name;
  int reading = 0;
  std::vector<int> rows;
};

/// The sweeps that the `sweep` column marks; without one, all runs of at least five consecutive rows in which one joint
/// alone moves by ten degrees or more. An error where a marked sweep moves several joints.
Result<std::vector<Sweep>> find_sweeps(const PoseSet& data);

/// Circle through the measured tool points of the sweep, with its uncertainty from the scatter about it.
SweepCircle fit_sweep(const Chain& nominal, const PoseSet& data, const Sweep& sweep);

/// Base and tool of `nominal` replaced by those that the sweeps show. An error where no two sweeps have axes that are
/// not parallel.
Result<FramesFound> frames_from_circles(const Chain& nominal, const PoseSet& data);

}  // namespace kinfer
