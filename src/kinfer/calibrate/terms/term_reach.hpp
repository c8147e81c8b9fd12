// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinfer/evidence/calibration/model_selection.hpp"

namespace kinfer::calibrate {

/// Where a term holds that was found among the fitted rows.
enum class TermReach {
  loads,    ///< one number a joint, wherever loads and temperatures are known
  joints,   ///< numbers of a joint's encoder and gear, as long as held-out ends of the joint space do not speak against
  measured  ///< a function of joint positions, where it was measured
};

TermReach reach_of(Term term);

}  // namespace kinfer::calibrate
