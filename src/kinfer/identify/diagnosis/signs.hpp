// SPDX-License-Identifier: Apache-2.0
// Which way each accelerometer points its +g. Specific force and lever arms negated together obey the same equations,
// so a sign that all sensors share is told by a magnetometer alone; that of one sensor also by the others' vertical
// rates.
#pragma once

#include "kinfer/identify/diagnosis/mended_log.hpp"

namespace kinfer::identify {

/// After the axes are mended: a sensor whose gyroscope was reversed and whose vertical then is opposite to its
/// neighbours' was left-handed.
void mend_signs(MendedLog& log, int threads);

}  // namespace kinfer::identify
