// SPDX-License-Identifier: Apache-2.0
// Angular velocity about the vertical, as each sensor measures it: ω · f/|f|. What turns the whole machine, or a joint
// with a vertical axis, turns all segments beyond it by the same rate. A sensor whose specific force is negated sees it
// negated, whatever its mounting.
#pragma once

#include <vector>

#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

struct VerticalAgreement {
  double correlation = 0.0;  ///< of the two vertical rates, 1: the same
  double shared_rate = 0.0;  ///< [rad/s] root of the covariance's magnitude
};

/// agreement[i][j] of each two sensors on one clock; zero where they have too little time in common.
std::vector<std::vector<VerticalAgreement>> vertical_agreement(const InsRecording& recording);

}  // namespace kinfer
