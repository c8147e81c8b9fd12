// SPDX-License-Identifier: Apache-2.0
// Paper 1's step for one segment: the sub-tree behind the fixed chain is searched, and then fixed.
#pragma once

#include "kinfer/identify/joints/joint_result.hpp"
#include "kinfer/identify/programming/link_engine.hpp"

namespace kinfer::identify {

/// The two segments of a joint, its signals, and the rows in which it moves.
struct JointSearch {
  const SegmentMotion &parent, &child;
  const std::vector<JointSignal>& signals;  ///< at least one
  const std::vector<std::size_t>& rows;
};

/// `chain_states`: of the parent's sensor by the chain so far; paper 1's engine continues from these, the others from
/// the parent's own measurements, so that errors do not accumulate along the chain.
JointResult search_joint(const JointSearch& search, const std::vector<FrameState>& chain_states,
                         const LinkEngine& engine, int threads, const Rng& rng, const Observer& observer);

/// Cost of eq. (20), in the terms of the search, of a revolute joint that was estimated otherwise: on these rows its
/// joint angle is the one nearest to the measured orientations, at the best heading of the one sensor against the
/// other, which no joint determines.
LinkFit fit_of_joint(const JointEstimate& revolute, const SegmentMotion& parent, const SegmentMotion& child,
                     const std::vector<std::size_t>& rows, OrientationMetric metric);

}  // namespace kinfer::identify
