// The fit of a machine's slow motion alone, after a fit of all of it: what the chain cannot explain at high frequencies
// then no longer speaks about its lengths (estimate/ins_low_band).
#pragma once

#include "kinfer/estimate/ins_fit.hpp"
#include "kinfer/identify/refine_setup.hpp"

namespace kinfer {

/// What every fit of one recording shares.
struct RefineTask {
  const InsRecording& recording;
  const RecordedMotion& motion;
  const SegmentTree& tree;
  const std::vector<JointStart>& starts;
  const SensorModel& grade;
  const InsFacts& facts;
  const InsFitOptions& options;
};

struct RefineFit {
  RefineSetup setup;
  InsFit fit;
};

/// What standard deviations of white noise do not contain.
struct ModelError {
  std::vector<MatrixXd> shift;  ///< of each body's unknowns, a column each thing that could be so or otherwise
  std::vector<double> lean;     ///< [rad] rms of each sensor against its segment, beyond what its mount's tilt explains
};

/// What the slow motion of a recording shows.
struct SlowMotion {
  RefineFit fitted;
  double cutoff = 0.0;          ///< [Hz] below which the motion was believed
  ModelError error;             ///< shifts: had √2 of the cutoff been believed; what is unexplained of the mounts
  std::vector<InsNoise> noise;  ///< of each sensor, as all of the motion shows it on knots that can hold it
};

/// After a fit of all motion: the chain that the slow motion shows, of several bands the one whose answer is surest,
/// its standard deviations and its shift towards the next wider band taken together. Mounts may give way
/// (yielding_mounts), and hinges that are none become balls where that explains notably more.
SlowMotion fit_slow_motion(const RefineTask& task, const RefineFit& found, const Observer& observer);

}  // namespace kinfer
