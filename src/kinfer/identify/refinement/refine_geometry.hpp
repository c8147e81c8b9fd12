// SPDX-License-Identifier: Apache-2.0
// Replaces the geometry that the search found by that of the continuous-time fit.
#pragma once

#include "kinfer/identify/refinement/refine.hpp"

namespace kinfer::identify {

/// Results of the fit that an Identification does not contain.
struct RefinementExtras {
  std::vector<ResidualClock> clocks{};  ///< residual clock errors; empty where the clocks agree
  HeldOut held_out{};
};

/// Replaces joints and canonical DH rows of an identification by refined ones; the joint types are kept. If the fit
/// fails, the result of the search is kept and a note gives the reason; with facts, this is an error.
Result<RefinementExtras> refine_geometry(Identification& result, const InsRecording& recording,
                                         const RecordedMotion& motion, const SegmentTree& tree,
                                         const RefinementOptions& options, const Observer& observer = {});

}  // namespace kinfer::identify
