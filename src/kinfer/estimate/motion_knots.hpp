// How fine the knots must be that a recording's motion asks for: chosen from the readings alone, before any chain is
// known, so that a quick arm is not mistaken for a chain that does not hold, and a slow machine not paid for twice.
#pragma once

#include "kinfer/measurement/ins_recording.hpp"

namespace kinfer {

constexpr double widest_knots = 0.1;  ///< [s] true to 1e-3 for waves of 2.5 Hz

/// [s] between knots, from `widest_knots` down to 0.025 s in steps of √2.
///
/// A spline is fitted to each sensor's readings, wider knots first, until knots finer by √2 leave hardly less: then
/// what is left is noise, or shaking too fast to be followed. The answer is finer than that by √2 once more, because
/// products of splines (a centripetal acceleration) have twice their frequencies. Where an interval would hold too few
/// readings to tell motion from noise the knots stay wider. Long recordings are judged by their liveliest two minutes.
double motion_knots(const InsRecording& recording);

}  // namespace kinfer
