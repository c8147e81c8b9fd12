// SPDX-License-Identifier: Apache-2.0
// Accelerometers that are out of step with the gyroscope of the same sensor: a filter's delay, or instruments that were
// logged apart.
#pragma once

#include "kinfer/identify/diagnosis/mended_log.hpp"

namespace kinfer::identify {

/// The specific force is shifted to the gyroscope's time: clocks are told by gyroscopes later on.
void mend_lags(MendedLog& log, int threads);

}  // namespace kinfer::identify
