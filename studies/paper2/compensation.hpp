// SPDX-License-Identifier: Apache-2.0
// Joint targets compensated by each identified model and sent to the real robot.
#pragma once

#include "methods.hpp"
#include "output.hpp"

namespace kinfer::paper2 {

/// For each model the distance between the real robot's tool and the nominal target, beside the model's own error at
/// the same joint positions. `problem.truth` is the real robot.
TextTable compensation_table(const Problem& problem, const Earlier& earlier);

}  // namespace kinfer::paper2
