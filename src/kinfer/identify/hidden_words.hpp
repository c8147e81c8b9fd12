// What cannot be known about a joint, in words, each with the one more measurement that would tell it.
#pragma once

#include "kinfer/evidence/identification.hpp"

namespace kinfer {

/// Fills `not_identifiable` of every joint from its hidden directions, its type and its `azimuth_undetermined`.
void say_what_is_hidden(std::vector<FoundJoint>& joints);

}  // namespace kinfer
