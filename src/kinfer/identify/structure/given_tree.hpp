// SPDX-License-Identifier: Apache-2.0
// A segment tree given by the user, and the evidence of the log against it.
#pragma once

#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/facts/findings.hpp"
#include "kinfer/identify/structure/segment_tree.hpp"

namespace kinfer::identify {

/// Two sensors whose segments share a joint.
struct GivenLink {
  std::string first, second;
};

/// The tree of these links with the root of the found tree. An error if a name is not a sensor's, or if the links do
/// not form a tree of all sensors.
Result<SegmentTree> given_tree(const SegmentTree& found, const std::vector<std::string>& names,
                               const std::vector<GivenLink>& links);

/// One for each given link that is not in the found tree: a fault if the log contradicts it, a note if it fits as well.
std::vector<Finding> findings_about(const SegmentTree& given, const SegmentTree& found,
                                    const std::vector<std::string>& names);

}  // namespace kinfer::identify
