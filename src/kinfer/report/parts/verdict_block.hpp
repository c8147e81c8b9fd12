// SPDX-License-Identifier: Apache-2.0
// The verdict at the top of a report: a coloured chip, the headline and what follows from it.
#pragma once

#include <string>

#include "kinfer/evidence/facts/records.hpp"

namespace kinfer::report {

/// `subject`: HTML, "Calibration of ER20".
std::string verdict_block(const VerdictRecord& verdict, const std::string& subject);

/// The text with a capital letter at its start.
std::string as_sentence(std::string text);

}  // namespace kinfer::report
