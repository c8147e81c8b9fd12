// From recordings to segments that are hung up in a tree and agree on where north is.
#pragma once

#include "kinfer/identify/given_tree.hpp"

namespace kinfer {

struct OrderedMotion {
  RecordedMotion motion;
  SegmentTree tree;
  std::vector<Finding> findings{};  ///< about the links that were given
};

/// Orientations without magnetometers, the tree, and then each segment's heading turned to agree with its parent's as
/// the pair's fit found it; magnetometers only decide what nothing else does. The paper's filter is left as it is: its
/// headings are its magnetometers'. `given`: links that are used instead of those that the log asks for.
Result<OrderedMotion> ordered_motion(const InsRecording& recording, const SegmentMotionOptions& options,
                                     const std::optional<std::string>& root, int threads,
                                     const std::vector<GivenLink>& given = {});

/// Turns every segment about up by the headings of the pairs between it and the root.
void agree_on_headings(RecordedMotion& motion, const SegmentTree& tree);

}  // namespace kinfer
