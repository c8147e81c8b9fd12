// SPDX-License-Identifier: Apache-2.0
// Predicted and measured motion, decimated for display, and the machine's joint trajectory.
#pragma once

#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/identify/refinement/held_out.hpp"
#include "kinfer/inertial/segment_motion.hpp"

namespace kinfer::identify {

/// Prediction: from the root's INS outwards, acceleration is propagated by each joint's lever arms and angular velocity
/// by its axis, with the measured motion along and about the axis. The residuals, in acceleration and in angular
/// velocity across the axes, are thus due to the geometry. Those of held-out windows are of the chain fitted without
/// them.
MotionEvidence motion_evidence(const RecordedMotion& motion, const Identification& found, const HeldOut& held = {});

}  // namespace kinfer::identify
