// SPDX-License-Identifier: Apache-2.0
// Sentences on the accuracy that a recording gives each joint.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/identification/joint_estimate.hpp"

namespace kinfer::words {

/// "the azimuth of ins1 about its only axis (± 11 mrad)"; `sd` [rad].
std::string azimuth_text(const std::string& sensor, double sd, bool is_unobservable);

/// "± 0.7 mm and ± 0.24 mrad": one standard deviation of the worst joint, both directions across the axis combined;
/// empty if none is known.
std::string accuracy_text(const std::vector<JointForecast>& joints);

/// "enough for 5 mm and 3 mrad in every joint", or which joints need what. `target`: the one of the forecast.
std::string forecast_text(const std::vector<JointForecast>& joints, const AccuracyTarget& target);

}  // namespace kinfer::words
