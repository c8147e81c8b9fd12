// SPDX-License-Identifier: Apache-2.0
// Allan deviation of a stationary sensor: noise density and bias instability (IEEE Std 952-1997, annex C).
#pragma once

#include <span>
#include <vector>

namespace kinfer {

struct AllanPoint {
  double tau = 0.0;        ///< [s] averaging time
  double deviation = 0.0;  ///< unit of the signal
};

/// Overlapping Allan deviation of a signal sampled every `period` seconds, at averaging times that grow by about
/// 10^(1/8) up to a third of the record. The values must be finite.
std::vector<AllanPoint> allan_deviation(std::span<const double> values, double period);

/// Figures read from the curve. White noise falls as density/√(2τ), with the density as in data sheets (sd of a sample
/// = density · √(sampling rate / 2)); the floor is 0.664 times the bias instability.
struct AllanCoefficients {
  double noise_density = 0.0;     ///< unit/√Hz, from averaging times up to 1 s, where the curve falls as 1/√τ
  double bias_instability = 0.0;  ///< unit; only an upper bound if the curve still falls at its end
  double instability_tau = 0.0;   ///< [s] averaging time of the minimum
  bool reaches_floor = false;     ///< the curve rises again: bias_instability is an estimate, not a bound
};
AllanCoefficients allan_coefficients(std::span<const AllanPoint> curve);

}  // namespace kinfer
