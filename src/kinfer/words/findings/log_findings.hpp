// SPDX-License-Identifier: Apache-2.0
// Sentences about faults of a log that are found before anything is fitted: units, signs, axes, clocks, rows.
#pragma once

#include <span>

#include "kinfer/words/findings/finding_words.hpp"

namespace kinfer::words {

std::span<const FindingWords> log_words();

}  // namespace kinfer::words
