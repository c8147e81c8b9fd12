// Joints in addition to the tree's: segments that close a loop, such as the four-bar linkage of a bucket.
#pragma once

#include "kinfer/evidence/findings.hpp"
#include "kinfer/identify/segment_order.hpp"

namespace kinfer {

/// Pairs off the tree that share a hinge as good as those of the tree between them, three or more joints apart, all of
/// which move. (Two apart, axes may just meet or coincide; turned about several axes, it may be a wrist's centre.)
std::vector<PairFit> loop_closing_pairs(const SegmentTree& tree);

/// A sentence for each of them.
std::vector<Finding> loop_findings(const SegmentTree& tree, const std::vector<PairFit>& closing,
                                   const std::vector<std::string>& names);

}  // namespace kinfer
