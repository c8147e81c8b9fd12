// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/urdf/urdf_tool.hpp"

namespace kinfer {
namespace {

bool has_written_base(const UrdfTree& tree) {
  const UrdfTree::Edge* edge = tree.edge_to(written_urdf::base_link);
  return tree.root == written_urdf::world_link && edge && edge->is_fixed && edge->parent == tree.root &&
         edge->joint.starts_with(written_urdf::base_joint);
}

bool is_target(const UrdfTree& tree, const UrdfTree::Edge& edge) {
  const bool is_named = edge.joint.size() > written_urdf::target_joint_prefix.size() &&
                        edge.joint.starts_with(written_urdf::target_joint_prefix);
  return is_named && edge.is_fixed && tree.is_leaf(edge.child);
}

}  // namespace

std::optional<WrittenTool> find_written_tool(const UrdfTree& tree) {
  const UrdfTree::Edge* edge = tree.edge_to(written_urdf::tool_link);
  if (!has_written_base(tree) || !edge || !edge->is_fixed || !edge->joint.starts_with(written_urdf::tool_joint))
    return std::nullopt;
  WrittenTool tool{.link = edge->child, .targets = {}};
  for (const UrdfTree::Edge& below : tree.edges) {
    if (below.parent != tool.link) continue;
    if (!is_target(tree, below)) return std::nullopt;
    tool.targets.push_back(&below);
  }
  return tool;
}

std::string_view target_name(const UrdfTree::Edge& target) {
  return std::string_view(target.joint).substr(written_urdf::target_joint_prefix.size());
}

}  // namespace kinfer
