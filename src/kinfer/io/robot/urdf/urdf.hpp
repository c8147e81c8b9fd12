// SPDX-License-Identifier: Apache-2.0
// Chains as URDF: read by urdfdom, written so that any URDF tool predicts the same poses.
//
// Joint gains and couplings are written as mimic joints about the same axis (multiplier gain − 1, or the coupling's
// factor).
#pragma once

#include <filesystem>
#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/io/robot/model/chain_ends.hpp"
#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

/// The joints from the base link to the tip link, fixed ones included; mimic joints become couplings. In a file that
/// kinfer wrote the chain ends at the tool, unless `ends` says otherwise, and then has its targets.
Result<Chain> read_urdf(const std::filesystem::path& path, const ChainEnds& ends = {});
Result<Chain> parse_urdf(const std::string& text, const std::string& name_in_messages, const ChainEnds& ends = {});

/// URDF text with links "world", "base", one link per joint, "tool", and each target as a fixed link.
std::string format_urdf(const Chain& chain);

}  // namespace kinfer
