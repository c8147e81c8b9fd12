// Predicted against measured motion, thinned for a screen, and the film of the machine.
#pragma once

#include "kinfer/evidence/identification.hpp"
#include "kinfer/identify/link_motion.hpp"
#include "kinfer/inertial/segment_motion.hpp"

namespace kinfer {

/// `states`: of the found chain, by segment, one a row; empty for segments that were not found. `joints`: of `chain`,
/// whose frames carry the names of the sensors.
MotionEvidence motion_evidence(const RecordedMotion& motion, const std::vector<std::vector<FrameState>>& states,
                               const Identification& found);

/// What to do next, most useful first.
std::vector<Advice> identification_advice(const Identification& found);

}  // namespace kinfer
