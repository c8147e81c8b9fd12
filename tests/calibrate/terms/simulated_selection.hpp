// SPDX-License-Identifier: Apache-2.0
// Simulated readings, and the steps of the model selection made from them.
#pragma once

#include <gtest/gtest.h>

#include "kinfer/evidence/calibration/calibration.hpp"
#include "support/instruments.hpp"

namespace kinfer::test {

inline PoseSet simulated_readings(const Chain& truth, int poses, int seed = 1) {
  return readings_of(measured(truth, paper2_poses(poses, noise_free), seed));
}

inline const SelectionStep& step_with(const Calibration& c, Term term) {
  for (const SelectionStep& step : c.model_selection.steps)
    if (step.term == term) return step;
  ADD_FAILURE() << "no step tests " << name(term);
  return c.model_selection.steps.front();
}

}  // namespace kinfer::test
