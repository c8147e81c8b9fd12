// SPDX-License-Identifier: Apache-2.0
// Converts facts about a machine, which refer to sensors and joints by name, to those of the continuous-time fit.
#pragma once

#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/estimate/continuous/model/problem.hpp"
#include "kinfer/measurement/machine_measurements.hpp"

namespace kinfer::identify {

/// `sensors`: names by index. The error names the fact that refers to something unknown, lies outside the recording, or
/// needs a stationary base.
Result<InsFacts> resolve_facts(const MachineMeasurements& facts, const std::vector<std::string>& sensors,
                               const InsBodies& bodies, const SplineGrid& grid, bool root_at_rest);

}  // namespace kinfer::identify
