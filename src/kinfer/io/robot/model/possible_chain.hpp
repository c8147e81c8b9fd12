// SPDX-License-Identifier: Apache-2.0
// Is a model that was read one that a machine can have? Every reader of models asks once; the verbs rely on it.
#pragma once

#include <optional>
#include <string>

#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

/// What is wrong with the joint's numbers, as a sentence without its place: "a: 1e+300 m is not possible for a length
/// (at most 2e+07 m)"; nothing where all can be.
std::optional<std::string> impossible_number(const Joint& joint);

/// Likewise for the rest of the chain (frames, targets, masses, fixtures), and a chain in which no joint moves.
std::optional<std::string> impossible_model(const Chain& chain);

}  // namespace kinfer
