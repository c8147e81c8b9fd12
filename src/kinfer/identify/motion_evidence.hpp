// Predicted against measured motion, thinned for a screen, and the film of the machine.
#pragma once

#include "kinfer/evidence/identification.hpp"
#include "kinfer/inertial/segment_motion.hpp"

namespace kinfer {

/// Predicted: from the root's INS outwards, each joint's lever arms carry the acceleration on and its axis the rate,
/// with the angle and its rates as measured. Rates across an axis and accelerations are thus what the geometry answers
/// for.
MotionEvidence motion_evidence(const RecordedMotion& motion, const Identification& found);

/// What to do next, most useful first.
std::vector<Advice> identification_advice(const Identification& found);

}  // namespace kinfer
