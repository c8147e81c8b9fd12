// SPDX-License-Identifier: Apache-2.0
// A carriage that slews steadily about the vertical is at rest but for its rate, which passes for a bias. The sensors
// of a recording together tell both apart: what they measure across the vertical is bias, and shows how large biases
// are; sensors that hang on one carriage measure one rate about the vertical; and a bias does not jump from one rest
// to the next. For a rest of sensor i with the rate v_i about the vertical, and the rests j of others meanwhile,
//   p(rotates) ∝ π ∫ p(r) t(v_i − r) Π_j ½ (t(v_j) + t(v_j − r)) dr,
//   p(rests)   ∝ t(v_i) ((1 − π) Π_j t(v_j) + π ∫ p(r) Π_j ½ (t(v_j) + t(v_j − r)) dr),
// t a Student density of the biases, about zero at first, then about those of the rests that are most certain.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "kinfer/inertial/rest/rest.hpp"

namespace kinfer {

/// The rests of each sensor of a recording. During a steady rotation `rotation` is its rate, which `angular_velocity`
/// is without.
std::vector<std::vector<RestPeriod>> rest_periods_of(const InsRecording& recording);

/// [rad/s] Half of the least component of a steady rotation; none without any.
std::optional<double> steady_rate_limit(std::span<const RestPeriod> rests);

}  // namespace kinfer
