// SPDX-License-Identifier: Apache-2.0
// Errors of one kind of measurement, and whether the rest of the data contradict a kind.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/calibrate/problem/task.hpp"
#include "kinfer/evidence/calibration/calibration_facts.hpp"

namespace kinfer::calibrate {

/// One per measurement: [m] at the tool point, or [rad] of orientations and tilts, where the true angle between the
/// measured and the predicted direction of up counts and not its sine, which the fit minimises.
std::vector<double> errors_of_kind(MeasurementKind kind, const Chain& chain, const PoseSet& data);

/// The kind of which the largest part of the measurements is contradicted: more than one in three of them is further
/// off than its noise and the tolerances of the nominal model together explain, while another kind is explained.
/// Nothing where there is no such kind. `chain` was fitted to `fitted_rows`, and is judged by all rows of the task.
std::optional<Contradiction> find_contradiction(const CalibrationTask& task, const Chain& chain,
                                                const PoseSet& fitted_rows);

}  // namespace kinfer::calibrate
