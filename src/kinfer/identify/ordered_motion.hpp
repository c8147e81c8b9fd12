// From recordings to segments that are hung up in a tree and agree on where north is.
#pragma once

#include "kinfer/identify/segment_order.hpp"

namespace kinfer {

struct OrderedMotion {
  RecordedMotion motion;
  SegmentTree tree;
};

/// Orientations without magnetometers, the tree, and then each segment's heading turned to agree with its parent's as
/// the pair's fit found it; magnetometers only decide what nothing else does. The paper's filter is left as it is: its
/// headings are its magnetometers'.
Result<OrderedMotion> ordered_motion(const InsRecording& recording, const SegmentMotionOptions& options,
                                     const std::optional<std::string>& root, int threads);

/// Turns every segment about up by the headings of the pairs between it and the root.
void agree_on_headings(RecordedMotion& motion, const SegmentTree& tree);

}  // namespace kinfer
