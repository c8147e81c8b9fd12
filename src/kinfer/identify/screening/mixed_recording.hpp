// SPDX-License-Identifier: Apache-2.0
// Whether the sensors were on the same segments before and after a time: logs of two machines that were put together,
// sensors that were exchanged, or one that came off.
//
// A joint is a property of two segments: wherever the sensors are fastened, the pair's fit explains its motion as well
// before as after. A pair that is a joint in one part and explains nothing like it in the other is none there.
#pragma once

#include <optional>

#include "kinfer/identify/screening/recording_selection.hpp"
#include "kinfer/inertial/segment_motion.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer::identify {

/// The part of a recording in which a pair of sensors shares a joint that it does not share in the rest.
struct MixedPart {
  double begin = 0.0, end = 0.0;  ///< [s] on the recording's clock
};

/// Orders the segments before and after `cut` [s], each by itself: orientations found across a change hold on neither
/// side. None where the trees agree, or where a part is too short or at rest.
std::optional<MixedPart> find_mixed_part(const InsRecording& recording, double cut, const SegmentMotionOptions& options,
                                         int threads);

/// Replaces findings about a remounted sensor, or about sensors that are left out, by mixed_recording where that is
/// what happened.
void name_mixed_recording(RecordingSelection& part, const InsRecording& recording, const SegmentMotionOptions& options,
                          int threads);

}  // namespace kinfer::identify
