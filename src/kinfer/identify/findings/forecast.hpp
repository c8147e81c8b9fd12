// SPDX-License-Identifier: Apache-2.0
// Whether a recording determines each joint accurately enough, and how much more excitation it would need.
#pragma once

#include "kinfer/evidence/identification.hpp"

namespace kinfer::identify {

/// Accuracy wanted of every joint, at 95 % confidence.
struct AccuracyTarget {
  double line = 5e-3;       ///< [m]
  double direction = 3e-3;  ///< [rad]
};

/// From the standard deviations of the observable parameters. Errors are taken as proportional to 1 / acceleration and
/// to 1 / sqrt(time).
std::vector<JointForecast> forecast(const std::vector<JointEstimate>& joints, const AccuracyTarget& target = {});

/// Whether a faster or longer recording of the same kind can be expected to determine an insufficient joint.
bool more_excitation_suffices(const JointForecast& joint);

bool all_sufficient(const std::vector<JointForecast>& joints);

/// Whether the azimuth about the parent's only rotation axis is less accurate than wanted of any direction.
bool is_azimuth_uncertain(const JointForecast& joint, const AccuracyTarget& target = {});

/// "the turn of ins1 about its only axis (± 11 mrad)"
std::string azimuth_text(const JointForecast& joint);

/// "± 0.7 mm and ± 0.24 mrad": one standard deviation of the worst joint, both directions across the axis combined;
/// empty if none is known.
std::string accuracy_text(const std::vector<JointForecast>& joints);

/// "enough for 5 mm and 3 mrad in every joint", or which joints need what.
std::string forecast_text(const std::vector<JointForecast>& joints, const AccuracyTarget& target = {});

}  // namespace kinfer::identify
