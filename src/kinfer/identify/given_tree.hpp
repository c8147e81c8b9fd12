// The tree that a user insists on, and what the log says against it.
#pragma once

#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/findings.hpp"
#include "kinfer/identify/segment_order.hpp"

namespace kinfer {

/// Two sensors whose segments share a joint.
struct GivenLink {
  std::string first, second;
};

/// The links hung up at the found tree's root. An error where a name is not a sensor's, or where the links are no tree
/// of all sensors.
Result<SegmentTree> given_tree(const SegmentTree& found, const std::vector<std::string>& names,
                               const std::vector<GivenLink>& links);

/// One for each given link that the found tree does not have: a fault where the log speaks against it, a note where it
/// fits as well.
std::vector<Finding> findings_about(const SegmentTree& given, const SegmentTree& found,
                                    const std::vector<std::string>& names);

}  // namespace kinfer
