// The readings of the same machine as if it had moved slowly only: what a chain cannot explain at high frequencies
// (soft mounts, play, filters inside the sensors, knots too wide) then no longer speaks about its lengths.
//
// Rates and forces are not linear in the motion, so filtering the readings would shorten levers: the mean of ω × (ω ×
// r) is not that of the mean ω. Hence with L a Gaussian low-pass, y the readings, x the whole motion and h(x) what the
// chain says about it: readings' = h(L x) + L (y − h(x)). Only what is left over is filtered; the slow motion L x is
// one that the chain can do. L y would differ from it by L h(x) − h(L x) (an eddy term, as in large-eddy simulation).
#pragma once

#include "kinfer/estimate/ins_problem.hpp"
#include "kinfer/measurement/ins_recording.hpp"

namespace kinfer {

/// Gaussian low-pass whose amplitude is 1/√2 at `cutoff` [Hz]: its standard deviation in time [s].
double gaussian_width(double cutoff);

/// L x: every channel of the motion, ends continued by what is there.
MatrixXd low_band(ConstMatrixRef band, const SplineGrid& grid, double cutoff);

/// readings' for the gyroscopes and accelerometers, row by row; faults and magnetometers stay as they are. `x` has the
/// whole motion on `problem`'s grid. Sensors are in the order of the problem.
InsRecording low_band_readings(const InsRecording& recording, const InsProblem& problem, const InsUnknowns& x,
                               double cutoff, int threads);

}  // namespace kinfer
