// SPDX-License-Identifier: Apache-2.0
// The geometry of the joints by the continuous-time fit, in place of that of the search.
#pragma once

#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/identify/refinement/refine.hpp"

namespace kinfer::identify {

/// Joints with their canonical DH rows, and what the fit that they come from says besides.
struct ChainGeometry {
  std::vector<JointEstimate> joints;  ///< parents before children
  std::vector<DhRowEstimate> dh;      ///< of all joints, in their order
  std::vector<LinkEstimate> links{};  ///< of the fit; none: as the joints have them
  std::vector<LoopEstimate> loops{};
  std::vector<PointEstimate> places{};
  std::vector<IdentificationNote> notes{};
  std::vector<ResidualClock> clocks{};              ///< residual clock errors; empty where the clocks agree
  std::optional<double> negative_log_likelihood{};  ///< of the fit; none: the geometry of the search
  std::vector<Finding> findings{};                  ///< about the instruments, from the fit
  bool starts_from_search = false;
  HeldOut held_out{};
  std::optional<TrackingModel> tracking{};  ///< of the fit
};

/// Fits the joints of the search to the whole recording; the joint types are kept. If the fit fails, the geometry of
/// the search is returned with a note on the reason; with facts, named zeros or a known machine, this is an
/// error.
Result<ChainGeometry> refine_geometry(ChainGeometry searched, const InsRecording& recording,
                                      const RecordedMotion& motion, const SegmentTree& tree,
                                      const RefinementOptions& options, const Observer& observer = {});

}  // namespace kinfer::identify
