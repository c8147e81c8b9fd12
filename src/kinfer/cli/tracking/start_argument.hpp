// SPDX-License-Identifier: Apache-2.0
// Where a machine is when tracking begins, as the user types it.
#pragma once

#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/kinematics/chain.hpp"

namespace kinfer::cli {

/// "0,-31.5,nan" in deg and mm; an error for a position outside the chain's limits.
Result<VectorXd> parse_start(const std::string& text, const Chain& chain);

}  // namespace kinfer::cli
