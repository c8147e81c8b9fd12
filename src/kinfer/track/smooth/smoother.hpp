// SPDX-License-Identifier: Apache-2.0
// Fixed-interval smoothing of a whole recording by two filters (Fraser and Potter 1969): one tracker runs through the
// recording forward, one backward, and each row's state is their mean by variance, joint by joint. Both make their own
// decisions on starts, faults, rests and the base.
//
// What both know of geometry and sensors has the same origin: that part of their errors is taken as common (`SharedSd`)
// and is not averaged out.
#pragma once

#include <functional>
#include <span>

#include "kinfer/base/observer.hpp"
#include "kinfer/evidence/tracking/track_state.hpp"
#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/measurement/ins/ins_row.hpp"
#include "kinfer/track/options.hpp"

namespace kinfer::track {

/// Calls `add` with the smoothed state of each row, in order; alarms and innovations are those of the forward pass.
/// Holds the state of the backward pass at
/// each row, 1 kB and more. `options.start` is where the recording begins.
void smooth(const TrackingModel& model, const TrackOptions& options, std::span<const InsRow> rows,
            const std::function<void(const TrackState&)>& add, const Observer& observer = {});

}  // namespace kinfer::track
