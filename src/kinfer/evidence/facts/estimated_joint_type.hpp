// SPDX-License-Identifier: Apache-2.0
// Types of joints that an identification tells apart.
#pragma once

#include <array>
#include <string_view>

namespace kinfer {

enum class EstimatedJointType { revolute, prismatic, universal, spherical, rigid };
std::string_view name(EstimatedJointType type);  ///< "revolute", "prismatic", "universal", "spherical", "rigid"

/// Probabilities of a joint's types given the relative motion of its two segments, in the order of the types.
struct JointTypeProbabilities {
  std::array<double, 5> of_type{};

  double of(EstimatedJointType type) const { return of_type[static_cast<std::size_t>(type)]; }
  double& of(EstimatedJointType type) { return of_type[static_cast<std::size_t>(type)]; }
};

EstimatedJointType most_probable(const JointTypeProbabilities& probabilities);

}  // namespace kinfer
