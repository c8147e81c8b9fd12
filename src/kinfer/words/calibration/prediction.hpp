// SPDX-License-Identifier: Apache-2.0
// Predictions of a calibrated chain in words.
#pragma once

#include <string>

namespace kinfer::words {

/// Why predictions of the chain in this file come without standard deviations.
std::string no_standard_deviations(const std::string& path);

}  // namespace kinfer::words
