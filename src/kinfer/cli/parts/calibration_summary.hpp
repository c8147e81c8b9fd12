// SPDX-License-Identifier: Apache-2.0
// Summary printed by a calibration: the verdict and compact tables.
#pragma once

#include <string>

#include "kinfer/evidence/calibration/calibration.hpp"

namespace kinfer::cli {

std::string calibration_summary(const Calibration& calibration);

/// "mean 0.020  rms 0.023  max 0.043 mm over 50"
std::string statistics_line(const ErrorStatistics& statistics);

}  // namespace kinfer::cli
