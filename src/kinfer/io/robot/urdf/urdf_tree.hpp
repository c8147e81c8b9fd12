// SPDX-License-Identifier: Apache-2.0
// The link tree of a URDF file, validated before the file is parsed, so that each error has its own sentence and line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/result.hpp"

namespace kinfer {

struct UrdfTree {
  struct Edge {
    std::string joint, parent, child;
    int line = 0;
    bool is_fixed = false;
  };
  std::vector<Edge> edges;         ///< joints in the order of the file
  std::vector<std::string> links;  ///< in the order of the file
  std::string root;                ///< the link without a parent
  std::string kinematics;          ///< the file reduced to names and joints (no meshes, no inertia)

  bool has_link(std::string_view name) const;
  const Edge* edge_to(std::string_view child) const;  ///< null for the root
  bool is_leaf(std::string_view link) const;
};

/// Malformed XML, missing or duplicate names, unknown links, links with two parents, loops and several roots are
/// errors.
Result<UrdfTree> parse_urdf_tree(std::string_view text, const std::string& name_in_messages);

}  // namespace kinfer
