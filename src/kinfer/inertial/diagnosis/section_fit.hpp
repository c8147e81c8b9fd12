// SPDX-License-Identifier: Apache-2.0
// Do the instruments of one sensor tell of the same motion? Over a short section in which mostly one joint moves, the
// sensor circles about it with a lever arm r, so that specific force and magnetic field are
//   f = Rᵀ g + ω̇ × r + ω × (ω × r),   m = Rᵀ h
// with R integrated from the gyroscope and g, r, h unknown: linear. Another unit, sign or order of the gyroscope's
// axes, or a shift in time, leaves larger residuals. Each section weighs by how well it fits, so that those in which
// one joint moves decide.
//
// For ω = u s P ω_file with a permutation P of determinant 1 with signs, s = ±1 and the unit u, f in these axes equals
// Pᵀ f in the file's: one integration for each u and s serves 24 maps.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// The 48 permutations of axes with signs; the first is the identity. Determinant −1: sense or handedness.
const std::vector<Mat3>& signed_permutations();

/// A direction and the rates of one sensor at equally spaced times, smoothed alike.
struct SectionSignals {
  std::vector<Vec3> direction;  ///< specific force [m/s²], or field; NaN in gaps
  std::vector<Vec3> rate;       ///< in the file's unit, less the bias at the quietest moment
  double noise_variance = 0.0;  ///< of the direction's samples: residual that a section may always have
  double quiet_variance = 0.0;  ///< of the direction's samples at the quietest moment
};

enum class LeverArm { free, none };

/// Empty where the recording is too short or an instrument is missing. `max_bias`: a quietest rate that is larger is
/// motion, in the file's unit.
std::optional<SectionSignals> section_signals(const TriadColumns& direction, const TriadColumns& rates,
                                              std::span<const double> time, double max_bias);

/// Log likelihood [nats] of each map in signed_permutations(), summed over the sections.
struct MapLikelihoods {
  std::array<double, 48> of{};
  double sections = 0.0;
};

/// The first steps of the sections in which the direction or the sensor moves: a direction that stays while the sensor
/// rotates is that of the axis.
std::vector<std::size_t> telling_sections(const SectionSignals& signals);

/// For rates in `unit` [rad/s]. Units are compared over the same sections: each that fits adds to the likelihood, also
/// one in which gravity shows nothing of the rotation.
MapLikelihoods map_likelihoods(const SectionSignals& signals, std::span<const std::size_t> sections, double unit,
                               LeverArm lever_arm);

/// Log likelihood [nats] of the rates times `factor`, their axes as they are, summed over the sections. A clock that
/// runs 1 / factor times too fast is the same; its lever arms then seem to be 1 / factor² times as long.
double factor_likelihood(const SectionSignals& signals, double factor);

struct InstrumentLag {
  double lag = 0.0;   ///< [s] of the direction behind the gyroscope
  double gain = 0.0;  ///< [nats] log likelihood of this lag over none
  /// [nats] That of the best other lag: vibration at rest fits at one lag in each half of its period.
  double rival_gain = 0.0;
  double half_gain = 0.0;  ///< [nats] the smaller one of that of either half of the sections
  double sd = 0.0;         ///< [s] from the curvature of the likelihood; 0: unknown
};

/// Lags up to 0.15 s either way. `map`: from the file's rates to the direction's axes, in rad/s.
InstrumentLag instrument_lag(const SectionSignals& signals, const Mat3& map);

}  // namespace kinfer
