// SPDX-License-Identifier: Apache-2.0
// Types of joints that an identification tells apart.
#pragma once

#include <string_view>

namespace kinfer {

enum class EstimatedJointType { revolute, prismatic, universal, spherical, rigid };
std::string_view name(EstimatedJointType type);  ///< "revolute", "prismatic", "universal", "spherical", "rigid"

}  // namespace kinfer
