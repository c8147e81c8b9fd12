// Is an earlier calibration still good on measurements that it never saw?
#pragma once

#include <optional>
#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/fit.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

struct Verification {
  ErrorStatistics as_it_stands;     ///< [m] errors of the measured points
  ErrorStatistics frames_refitted;  ///< [m] after refitting base and tool: tells a moved tracker from a changed robot
  bool good = true;
  std::string verdict;  ///< one sentence
};

/// Good: the rms error is within three times the scatter that the instrument promises; where no instrument is known,
/// when refitting base and tool does not halve it.
Result<Verification> verify(const Chain& chain, const Tolerances& tolerances,
                            const std::optional<Instrument>& instrument, const PoseSet& data);

}  // namespace kinfer
