// How well the data fix a hinge: the Cramér-Rao bound of its ten numbers with the noise that the residuals show.
//
// Statistical only: what the filter, the smoothing or a frozen chain before it do wrong alike at all times does not
// show in it.
#pragma once

#include "kinfer/evidence/identification.hpp"
#include "kinfer/identify/hinge_geometry.hpp"

namespace kinfer {

struct HingePrecision {
  JointDeviation sd;
  std::vector<Vec3> hidden_in_parent, hidden_in_child;  ///< unit, in the sensors: lever directions that no signal sees
  std::vector<DhNumbers> canonical_sd;                  ///< of the joint's rows; empty: not estimated
};

/// `angle`: of the hinge at each row, with its derivatives. `rows` that were fitted.
HingePrecision hinge_precision(const HingeGeometry& hinge, const std::vector<FrameState>& parent,
                               const std::vector<FrameState>& child, const JointSignal& angle,
                               const std::vector<std::size_t>& rows);

}  // namespace kinfer
