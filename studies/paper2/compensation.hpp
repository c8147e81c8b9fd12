// SPDX-License-Identifier: Apache-2.0
// What it was all for: joint targets corrected by each identified model, sent to the real robot.
#pragma once

#include "methods.hpp"
#include "output.hpp"

namespace kinfer::paper2 {

/// For each model the distance between where the real robot's tool goes and where the nominal model wanted it, beside
/// the model's own error at the same readings. `problem.truth` is the real robot.
TextTable compensation_table(const Problem& problem, const Earlier& earlier);

}  // namespace kinfer::paper2
