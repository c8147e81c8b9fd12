// SPDX-License-Identifier: Apache-2.0
// A recording played backward is that of a machine that moves backward: positions and specific forces stay, angular
// velocities and, with them, the gyroscopes' biases change their sign.
#pragma once

#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/measurement/ins/ins_row.hpp"

namespace kinfer::track {

/// As it would be identified from the recording played backward.
TrackingModel reversed(TrackingModel model);

/// `end` [s]: of the recording, which becomes time 0. Clipped angular velocities stay clipped.
InsRow reversed(InsRow row, double end);

}  // namespace kinfer::track
