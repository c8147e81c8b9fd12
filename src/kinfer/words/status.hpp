// SPDX-License-Identifier: Apache-2.0
// How a search or an inverse-kinematics iteration ended, in words.
#pragma once

#include <string>

#include "kinfer/base/stop.hpp"
#include "kinfer/kinematics/inverse.hpp"

namespace kinfer::words {

std::string sentence(Stop stop);  ///< "converged: the cost no longer falls"
std::string sentence(InverseStatus status);

}  // namespace kinfer::words
