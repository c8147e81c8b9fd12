// SPDX-License-Identifier: Apache-2.0
// The gyroscopes' biases that a fit has found where no rest tells them.
#pragma once

#include "kinfer/estimate/continuous/model/problem.hpp"
#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/inertial/segment_motion.hpp"

namespace kinfer::identify {

/// Of the sensors that never rest in the recording, in its units: `common` are the scales by which it was divided. The
/// chain tells a bias to a fraction of what a filter of one sensor alone knows.
std::vector<GyroscopeBias> told_biases(const TrackingModel& model, const InsRecording& recording,
                                       const InsCommonScales& common);

/// Whether the sensor's bias is among those that were told before, within their standard deviations.
bool agrees_with_one_of(const std::vector<GyroscopeBias>& before, const GyroscopeBias& bias);

}  // namespace kinfer::identify
