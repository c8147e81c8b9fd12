// What the residuals of a fit say about the noise: how large it is, and how long it remembers.
#pragma once

#include "kinfer/estimate/ins_cost.hpp"

namespace kinfer {

/// How many times larger the variance of a mean over a long time is than for white noise: 1 + 2 Σ ρ over the lags of
/// the offsets' autocorrelation up to the first that is not positive, and no farther than a tenth of the recording.
/// Mean over the axes; at least 1.
double memory_of(const InstrumentFit& fit);

/// Gives every instrument the standard deviation that its residuals have, spikes left out; the magnetometers', whose
/// disturbances are slow, their memory too. Never less than the least. True where one of them changed notably.
bool reweigh(InsProblem& problem, const InsCost& cost);

/// True where that would change a gyroscope's or an accelerometer's notably.
bool is_stale(const InsProblem& problem, const InsCost& cost);

}  // namespace kinfer
