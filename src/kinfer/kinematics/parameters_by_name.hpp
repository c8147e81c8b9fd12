// SPDX-License-Identifier: Apache-2.0
// The numbers of a chain by their names: what two chains have in common, whatever the order of their terms.
#pragma once

#include <map>
#include <string>

#include "kinfer/kinematics/parameter_address.hpp"

namespace kinfer {

/// Every number that a calibration may free.
std::map<std::string, ParameterAddress> addresses_by_name(const Chain& chain);

}  // namespace kinfer
