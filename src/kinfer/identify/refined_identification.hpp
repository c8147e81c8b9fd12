// The continuous-time fit put in the place of what the search found.
#pragma once

#include "kinfer/identify/refine.hpp"

namespace kinfer {

/// What an identification has no place for.
struct RefinedGeometry {
  std::vector<RefinedClock> clocks{};  ///< what is left of the clocks' errors; nothing where they are right
  HeldOut held_out{};
};

/// Replaces joints and canonical rows of an identification by refined ones; the joint types stay. Where the fit has no
/// answer, everything stays as the search found it and a note says why. An error where the facts do not fit the
/// machine.
Result<RefinedGeometry> refine_geometry(Identification& result, const InsRecording& recording,
                                        const RecordedMotion& motion, const SegmentTree& tree,
                                        const RefineOptions& options, const Observer& observer = {});

}  // namespace kinfer
