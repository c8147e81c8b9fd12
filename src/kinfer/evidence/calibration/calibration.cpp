// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/calibration/calibration.hpp"

namespace kinfer {

Chain corrected_chain(const Calibration& calibration) {
  return with_small_rotations_folded(calibration.estimate.chain);
}

bool has_lengths(const Calibration& calibration) {
  return calibration.after.position.train.n > 0;
}

const ErrorStatistics& reported_errors(const Calibration& calibration, const ChainFit& fit) {
  const TrainHoldout& errors = has_lengths(calibration) ? fit.position : fit.orientation;
  return errors.holdout.n > 0 ? errors.holdout : errors.train;
}

const ErrorStatistics& final_errors(const Calibration& calibration) {
  return has_lengths(calibration) ? calibration.after.position.train : calibration.after.orientation.train;
}

AccuracyStatistics accuracy_statistics(const std::vector<PoseAccuracy>& poses) {
  std::vector<double> before, after, repeatability;
  for (const PoseAccuracy& pose : poses) {
    before.push_back(pose.accuracy_before), after.push_back(pose.accuracy_after);
    if (pose.repeatability) repeatability.push_back(*pose.repeatability);
  }
  return {error_statistics(before), error_statistics(after), error_statistics(repeatability)};
}

}  // namespace kinfer
