// SPDX-License-Identifier: Apache-2.0
// Whether a robot is one of the population that its prior was made of.
#pragma once

#include <optional>

#include "kinfer/calibrate/problem/options.hpp"
#include "kinfer/calibrate/problem/task.hpp"
#include "kinfer/evidence/calibration/calibration_facts.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::calibrate {

struct PopulationChoice {
  CalibrationTask task;  ///< without the population where the robot is foreign to it
  std::optional<CalibrationNote> note{};
};

/// Compares the likelihood of the `fitted` rows under the population and under the robot's own tolerances, in a fit
/// that does not know the population.
Result<PopulationChoice> choose_population(const CalibrationTask& task, const PoseSet& fitted,
                                           const ParameterChoice& parameters, Rng rng);

}  // namespace kinfer::calibrate
