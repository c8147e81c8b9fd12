// SPDX-License-Identifier: Apache-2.0
// Measurements of the same machine as if only the low-frequency part of its motion had happened: high-frequency effects
// that a rigid chain cannot explain (soft mounts, backlash, filters inside the sensors, knots too wide) then no longer
// bias its lengths.
//
// Measurements are not linear in the motion, so filtering them would shorten lever arms: the mean of ω × (ω × r) is not
// that of the mean ω. Hence with L a Gaussian low-pass, y the measurements, x the full motion and h(x) the predicted
// measurements: y' = h(L x) + L (y − h(x)). Only the residual is filtered; the low-frequency motion L x is feasible for
// the chain. L y would differ from y' by L h(x) − h(L x), the analogue of the subgrid term in large-eddy simulation.
#pragma once

#include "kinfer/estimate/continuous/model/problem.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// Gaussian low-pass whose amplitude is 1/√2 at `cutoff` [Hz]: its standard deviation in time [s].
double gaussian_width(double cutoff);

/// L x: every spline dimension of the motion; at the ends the kernel is truncated and renormalised.
MatrixXd low_frequency_motion(ConstMatrixRef coefficients, const SplineGrid& grid, double cutoff);

/// y' for gyroscopes and accelerometers, sample by sample; faulty samples and magnetometers are not changed. `x` is the
/// full motion on `problem`'s grid. Sensors are in the order of the problem.
InsRecording low_frequency_measurements(const InsRecording& recording, const InsProblem& problem, const InsUnknowns& x,
                                        double cutoff, int threads);

}  // namespace kinfer
