// Predicted against measured motion, thinned for a screen, and the film of the machine.
#pragma once

#include "kinfer/evidence/identification.hpp"
#include "kinfer/identify/held_out.hpp"
#include "kinfer/inertial/segment_motion.hpp"

namespace kinfer {

/// Predicted: from the root's INS outwards, each joint's lever arms carry the acceleration on and its axis the rate,
/// with the angle and its rates as measured. Rates across an axis and accelerations are thus what the geometry answers
/// for. What is left in held-out windows is that of the chain which did not see them.
MotionEvidence motion_evidence(const RecordedMotion& motion, const Identification& found, const HeldOut& held = {});

/// What to do next, most useful first.
std::vector<Advice> identification_advice(const Identification& found);

/// [s] of the film's frames.
std::vector<double> film_times(const RecordedMotion& motion);

}  // namespace kinfer
