// SPDX-License-Identifier: Apache-2.0
// Chains as MJCF, MuJoCo's model format: read without MuJoCo, written so that MuJoCo finds the same poses.
#pragma once

#include <filesystem>
#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/io/robot/mjcf/mjcf_tree.hpp"
#include "kinfer/io/robot/model/chain_ends.hpp"
#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

/// The joints from the base, the world or a body, to the tip, a body or a site. A hinge or slide joint becomes a joint,
/// a body without joints and the tip a fixed one; joints that an <equality> ties to another become couplings. Joint
/// positions are MuJoCo's qpos. Loops (connect, weld) are left open; free and ball joints on the way are errors.
Result<Chain> parse_mjcf(const std::string& text, const std::string& name_in_messages, const ChainEnds& ends = {});

/// The name of the site that has the tool's frame, in files that are written.
inline const std::string tool_site = "tool";

/// The ends that an empty name stands for: "world", and the body at the end of the longest path of moving joints (in a
/// file that kinfer wrote: the one with the tool), or its site `tool_site` where it has one.
Result<ChainEnds> mjcf_ends(const MjcfTree& tree, const std::string& name_in_messages, const ChainEnds& ends);

/// Pose of the body's frame in the frame that the chain has there: that of the body's last joint, which lies in the
/// joint's point, or the body's own where it has no joint or is the base of the chain (−1: the world).
Pose mjcf_attachment(const MjcfTree& tree, int body, int base);

/// MJCF text: one body per joint, whose site has the joint's frame; sites for the tool and the targets. Joint gains and
/// couplings become further joints on the same axis, constrained by <equality>, and so are the joints that close loops
/// (connect: by their points). Kinematics only: bodies without a known
/// mass get a small one (boundmass).
std::string format_mjcf(const Chain& chain);

}  // namespace kinfer
