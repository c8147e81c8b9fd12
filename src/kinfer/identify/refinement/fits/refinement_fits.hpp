// SPDX-License-Identifier: Apache-2.0
// Fits of one recording that start from each other: with the chain fixed, and of all unknowns.
#pragma once

#include "kinfer/estimate/continuous/solver/batch_fit.hpp"
#include "kinfer/identify/handover/named_zero.hpp"
#include "kinfer/identify/refinement/fits/refinement_setup.hpp"

namespace kinfer::identify {

/// Inputs that all fits of one recording share.
struct RefinementTask {
  const InsRecording& recording;
  const RecordedMotion& motion;
  const SegmentTree& tree;
  const std::vector<InitialJoint>& starts;
  const SensorModel& grade;
  const InsFacts& facts;
  const InsFitOptions& options;
  const std::vector<NamedZero>& zeros;
  double least_noise = 1.0;  ///< in units of the quietest instruments' noise
  InsCommonScales common{};  ///< by which the recording was divided
};

struct RefinementFit {
  RefinementSetup setup;
  InsFit fit;
};

/// Anchors the joint positions at their current values: keeps an unobservable constant of them where it is.
void anchor(RefinementSetup& setup);

void report_progress(const Observer& observer, const char* stage, double fraction);

/// The set-up for a recording of the same machine, starting from the unknowns `found` of another problem.
RefinementSetup continue_from(const RefinementTask& task, const InsRecording& recording, double knot_spacing,
                              const InsProblem& problem, const InsUnknowns& found);

/// Fits the motion alone, the chain held fixed.
InsFit fit_motion_only(const RefinementTask& task, RefinementSetup& setup);

/// The motion at full bandwidth, on the finest knots.
RefinementFit fit_whole_motion(const RefinementTask& task, const RefinementFit& found);

/// A few iterations in all unknowns.
RefinementFit fit_from(const RefinementTask& task, RefinementSetup setup);

/// Fits again from the result, after `change` of the set-up.
template <class Change>
RefinementFit refit_with(const RefinementTask& task, const RefinementFit& fitted, Change change) {
  RefinementSetup setup = fitted.setup;
  setup.start = fitted.fit.unknowns;
  change(setup);
  return fit_from(task, std::move(setup));
}

/// The steps in the bodies' unknowns from one estimate to another, a column each.
std::vector<MatrixXd> shifts(const InsBodies& from, const InsBodies& to);

/// Largest ratio of residual noise to noise floor over all instruments.
double worst_misfit(const InsProblem& problem);

/// Σ log of the instruments' residual noise; outliers have little weight.
double log_residual(const RefinementFit& fitted);

}  // namespace kinfer::identify
