// SPDX-License-Identifier: Apache-2.0
// The drift of headings in long recordings, where it passes for a second, vertical axis of every joint.
#pragma once

#include <cstddef>
#include <vector>

#include "kinfer/inertial/segment_motion.hpp"

namespace kinfer::identify {

/// The relative rotations parent_R_child at the rows, without what the child's headings drift relative to the parent's:
/// by the angles about the vertical that leave least of the motion of one axis. A short recording stays as it is. Of a
/// second axis that moves within half a minute enough is left.
std::vector<Mat3> without_heading_drift(const RecordedMotion& motion, const SegmentMotion& parent,
                                        const SegmentMotion& child, const std::vector<std::size_t>& rows,
                                        std::vector<Mat3> rotations);

}  // namespace kinfer::identify
