// SPDX-License-Identifier: Apache-2.0
// Zeros of joint positions on the command line.
#pragma once

#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/identify/handover/named_zero.hpp"

namespace kinfer::cli {

/// "swing=0deg@12.5s,boom=-30deg@12.5s": a joint, its position and the time in the log at which it had that position.
Result<std::vector<identify::NamedZero>> parse_zeros(const std::string& text);

}  // namespace kinfer::cli
