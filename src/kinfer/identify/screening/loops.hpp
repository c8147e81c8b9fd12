// SPDX-License-Identifier: Apache-2.0
// Joints that are not in the tree: they close a kinematic loop, such as the four-bar linkage of a bucket.
#pragma once

#include "kinfer/evidence/facts/findings.hpp"
#include "kinfer/identify/structure/segment_tree.hpp"

namespace kinfer::identify {

/// Pairs outside the tree that share a revolute joint as well as the pairs on the tree's path between them do; the path
/// has three or more revolute joints, all moving. (With two, the axes may merely intersect or coincide; a joint with
/// several axes may be the centre of a wrist.)
std::vector<PairFit> loop_closing_pairs(const SegmentTree& tree);

/// One finding for each loop.
std::vector<Finding> loop_findings(const SegmentTree& tree, const std::vector<PairFit>& closing,
                                   const std::vector<std::string>& names);

}  // namespace kinfer::identify
