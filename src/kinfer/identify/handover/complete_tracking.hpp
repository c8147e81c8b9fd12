// SPDX-License-Identifier: Apache-2.0
// What a tracking model takes from the steps beside the fit: clocks, the tool, and gyroscope biases that gravity
// shows.
#pragma once

#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer::identify {

/// `found`: with its chain, places and clocks. `recording`: that was fitted, divided by `common`.
TrackingModel complete(TrackingModel model, const Identification& found, const InsRecording& recording,
                       const InsCommonScales& common);

/// A root that moves has a free angular velocity and a free specific force in the fit: that gravity is the same all the
/// time is not used, and a gyroscope bias common to all sensors is left to its prior and to whatever else the model
/// does not explain. Each sensor's orientation filter knows gravity. Its bias corrects those of the fit, and with them
/// all errors of the sensors, by their joint covariance; the geometry is considered and keeps its values. Biases that
/// the fit determined are far better known than the filter's, and stay. `model` is returned as it is if its base was
/// still. `recording` was divided by `common`, the model's biases are in the units of the instruments.
TrackingModel with_filtered_biases(TrackingModel model, const InsRecording& recording, const InsCommonScales& common);

}  // namespace kinfer::identify
