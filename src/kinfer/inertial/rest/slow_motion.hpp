// SPDX-License-Identifier: Apache-2.0
// Whether a sensor that hardly rotates is at rest or moves slowly. What a base at rest shows, vibration and noise,
// vanishes in the medians over a second but for the drift of the biases; slow motion does not. With the largest
// deviations of the medians from what is usual in the recording, of the rates across the vertical r and about it v, and
// of the specific forces f,
//   odds = Σ p(r, v, f | moves) / p(r | rests) p(v | r, rests) p(f | rests).
// A bias that drifts does so in all directions alike, and moves no force. A motion is about the vertical, which changes
// v alone, or it tilts the sensor, which moves f by about g r times some seconds.
#pragma once

#include <span>

#include "kinfer/geometry/log_normal.hpp"
#include "kinfer/inertial/rest/rest.hpp"

namespace kinfer {

/// [rad/s] and [m/s²] Largest deviation of medians over a second from their median, of sensors at rest: biases that
/// drift by 0.003 rad/s while the sensors warm up (1.5e-3), noise (rms 2e-4 to 6e-4 and 0.0016 to 0.0042 in twelve
/// simulated recordings of three grades). Larger medians take slow motion for rest.
inline constexpr LogNormal rest_rate_deviation{1.5e-3, 0.7}, rest_force_deviation{0.015, 1.0};
/// Of the drift of a bias: what lies along one direction, times what lies across it. Three equal components would have
/// 0.7; larger spreads take slow slews for drifts.
inline constexpr LogNormal drift_ratio{0.7, 0.8};
/// Likewise of sensors that move: a hinge of 1.7° has 0.02 to 0.08 rad/s, a slew as much as its rate. Larger medians
/// take slow motion for rest.
inline constexpr LogNormal moving_rate_deviation{0.3, 1.6};
/// [s] Force's deviation over g times the rate's, of motion that tilts: 0.4 to 1.5 of a hinge, 20 of a slow boom.
/// Larger medians take drifts for rest the more surely, and quick small motion with them.
inline constexpr LogNormal tilting_time{2.0, 1.2};
/// Of the medians: the farthest ones that are left out, shocks and spikes. Larger: a short movement is overlooked.
inline constexpr double max_shock_median_share = 0.02;

/// Medians over a second deviate from their own median by so much, the farthest fiftieth left out (shocks).
struct SlowDeviations {
  double rate_across = 0.0;  ///< [rad/s] across the vertical
  double rate_about = 0.0;   ///< [rad/s] about it
  double force = 0.0;        ///< [m/s²] in the sensor
};
SlowDeviations slow_deviations(const InsSensor& sensor, std::span<const double> time);

/// ln p(moves) / p(rests).
double slow_motion_log_odds(const SlowDeviations& deviations);

/// Whether it is more likely that the sensor moves slowly than that it rests, or rotates steadily in its `rests`.
bool moves_slowly(const InsSensor& sensor, std::span<const double> time, std::span<const RestPeriod> rests);

}  // namespace kinfer
