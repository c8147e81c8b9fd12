// The tree of a URDF file, checked before anything is read from it, so that each fault has its sentence and line.
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
  };
  std::vector<Edge> edges;         ///< joints in the order of the file
  std::vector<std::string> links;  ///< in the order of the file
  std::string root;                ///< the link without a parent
  std::string kinematics;          ///< the file again, with names, joints and nothing else (no meshes, no inertia)

  bool has_link(std::string_view name) const;
  const Edge* edge_to(std::string_view child) const;  ///< null for the root
  bool is_leaf(std::string_view link) const;
};

/// Malformed XML, missing or doubled names, unknown links, links with two parents, loops and several roots are errors.
Result<UrdfTree> check_urdf(std::string_view text, const std::string& name_in_messages);

}  // namespace kinfer
