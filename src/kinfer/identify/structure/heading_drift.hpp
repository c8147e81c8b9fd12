// SPDX-License-Identifier: Apache-2.0
// The drift of headings in long recordings and their steps behind gaps, which pass for a second, vertical axis of every
// joint.
#pragma once

#include <cstddef>
#include <vector>

#include "kinfer/inertial/segment_motion.hpp"

namespace kinfer::identify {

/// The relative rotations parent_R_child at the rows, without what the child's headings drift relative to the parent's
/// and step behind gaps of either sensor: by the angles about the vertical that leave least of the motion of one axis.
/// A short recording without gaps stays as it is. Of a second axis that moves within half a minute, or within the part
/// between two gaps, enough is left.
std::vector<Mat3> without_heading_drift(const RecordedMotion& motion, const SegmentMotion& parent,
                                        const SegmentMotion& child, const std::vector<std::size_t>& rows,
                                        std::vector<Mat3> rotations);

}  // namespace kinfer::identify
