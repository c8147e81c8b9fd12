// SPDX-License-Identifier: Apache-2.0
// Regular sampling behind irregular time stamps: a sensor samples with its own quartz, but its rows are often stamped
// when they arrive, late by a varying time (jitter) or several at once (packets).
//
// A grid t = offset + period · n is fitted to the stamps (robust regression, Huber 1964), n the number of the sample.
// Whether samples were lost can only be guessed from the stamps, so both guesses are fitted. Which times are right is
// decided by the signals: at the right times they are smooth, at wrong ones they scatter by the time's error times
// their derivative. Each window of eight samples is fitted by a cubic at both times; the logarithm of the ratio of the
// residual sums of squares, times half the degrees of freedom, is the log likelihood ratio with unknown noise.
#pragma once

#include <optional>

#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

struct SamplingGrid {
  double period = 0.0;       ///< [s]
  std::vector<double> time;  ///< [s] one per row, strictly increasing
};

enum class LostSamples {
  in_gaps_only,  ///< every row is one period after the one before, whatever its stamp says, but for gaps
  anywhere       ///< rows are so many periods apart as their stamps say
};

/// Empty if the stamps do not agree with regular sampling: the grid would not be in the order of the rows.
std::optional<SamplingGrid> fit_sampling_grid(std::span<const double> stamps, LostSamples lost);

/// [s] rms difference of two sequences of times about its mean.
double time_scatter(std::span<const double> stamps, std::span<const double> times);

/// Log likelihood ratio [nats] of two sequences of times for the rows of a sensor, summed over windows, with the
/// variance of the sum from the scatter among windows.
struct TimeEvidence {
  double gain = 0.0, variance = 0.0;  ///< of `other` over `stamps`

  void add(const TimeEvidence& more) { gain += more.gain, variance += more.variance; }
  bool favours_other() const;
};

/// `stride`: rows from one sample of a window to the next, so that windows hold several packets: within a packet wrong
/// times are evenly spaced, too.
TimeEvidence compare_times(const InsSensor& sensor, std::span<const double> stamps, std::span<const double> other,
                           std::size_t stride = 1);

/// The stride for stamps that scatter about a grid by `scatter` [s]: eight samples hold four packets, if it comes from
/// packets.
std::size_t window_stride(double scatter, double period);

}  // namespace kinfer
