// SPDX-License-Identifier: Apache-2.0
// Whether a recording determines each joint accurately enough, and how much more excitation it would need.
#pragma once

#include "kinfer/evidence/identification/joint_estimate.hpp"

namespace kinfer::identify {

/// From the standard deviations of the observable parameters; rigid joints have none. A joint whose line or direction
/// is unknown is never sufficient. Errors are taken as proportional to 1 / acceleration and to 1 / sqrt(time).
std::vector<JointForecast> forecast(const std::vector<JointEstimate>& joints, const AccuracyTarget& target = {});

}  // namespace kinfer::identify
