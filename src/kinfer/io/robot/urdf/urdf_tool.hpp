// SPDX-License-Identifier: Apache-2.0
// Tool and targets in a URDF that kinfer wrote. A target is a link below the tool, so that the tool is no leaf of the
// tree; the names that the writer gives tell it from a link on the way to the end of an arm.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/io/robot/urdf/urdf_tree.hpp"

namespace kinfer {

// Names that format_urdf gives. Where a chain uses them too, a link or joint gets a number behind its name.
namespace written_urdf {
inline const std::string world_link = "world", base_link = "base", tool_link = "tool";
inline const std::string base_joint = "world_to_base", tool_joint = "flange_to_tool";
inline const std::string target_joint_prefix = "tool_to_";  ///< before the name of the target
}  // namespace written_urdf

struct WrittenTool {
  std::string link;
  std::vector<const UrdfTree::Edge*> targets;  ///< fixed joints from the tool to each target, in the order of the file
};

/// None where the file was not written by kinfer, or something other than targets was attached to its tool since.
std::optional<WrittenTool> find_written_tool(const UrdfTree& tree);

/// The name of the target, as the file has it.
std::string_view target_name(const UrdfTree::Edge& target);

}  // namespace kinfer
