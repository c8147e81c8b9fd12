// SPDX-License-Identifier: Apache-2.0
// From recordings to a segment tree whose segments have consistent headings.
#pragma once

#include "kinfer/identify/structure/given_tree.hpp"

namespace kinfer::identify {

struct OrderedMotion {
  RecordedMotion motion;
  SegmentTree tree;
  std::vector<Finding> findings{};  ///< about the given links
};

/// Orientations without magnetometers, the segment tree, and then each segment's heading corrected to its parent's by
/// the pair's fit; magnetometers only determine what nothing else does. With paper 1's filter the headings stay those
/// of the magnetometers. `given`: links that are used instead of the estimated ones.
Result<OrderedMotion> order_segments(const InsRecording& recording, const SegmentMotionOptions& options,
                                     const std::optional<std::string>& root, int threads,
                                     const std::vector<GivenLink>& given = {});

/// Rotates every segment about the vertical by the headings of the pairs between it and the root.
void align_headings(RecordedMotion& motion, const SegmentTree& tree);

}  // namespace kinfer::identify
