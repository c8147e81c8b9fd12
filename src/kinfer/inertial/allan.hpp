// Allan deviation of a still sensor: what its noise and the wandering of its bias are worth (IEEE Std 952-1997, annex
// C).
#pragma once

#include <span>
#include <vector>

namespace kinfer {

struct AllanPoint {
  double tau = 0.0;        ///< [s] averaging time
  double deviation = 0.0;  ///< unit of the signal
};

/// Overlapping Allan deviation of a signal sampled every `period` seconds, at averaging times that grow by about
/// 10^(1/8) up to a third of the record. Missing numbers must not be among the values.
std::vector<AllanPoint> allan_deviation(std::span<const double> values, double period);

/// What the curve says. White noise falls as density/√(2τ), with the density as data
/// sheets state it (sd of a row = density · √(rate / 2)); a flat floor is bias instability / 0.664.
struct AllanFigures {
  double noise_density = 0.0;     ///< unit/√Hz, from averaging times of up to 1 s where the curve falls as 1/√τ
  double bias_instability = 0.0;  ///< unit; an upper bound where the curve still falls at its end
  double instability_tau = 0.0;   ///< [s] where the curve is lowest
  bool reaches_floor = false;     ///< the curve rises again, so that bias_instability is a figure and no bound
};
AllanFigures allan_figures(std::span<const AllanPoint> curve);

}  // namespace kinfer
