// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/possible_times.hpp"

#include <fmt/format.h>

namespace kinfer {
namespace {

constexpr double longest_period = 0.5;    // [s] a log of 1 kHz in ms reads 1 s; no motion is seen at 2 Hz
constexpr double shortest_period = 1e-5;  // [s] no INS samples at 100 kHz
constexpr double most_empty = 1000.0;     // rows that could have been between those that are there, for each of them
constexpr double most_rows = 5e7;         // of a regular grid: a day of 500 Hz

Result<void> check_times(const InsLogger& logger) {
  const double period = median_period(logger.time);
  if (logger.time.size() < 3) return {};
  if (period > longest_period || period < shortest_period)
    return error(
        "{}: rows are {:g} s apart, expected {:g} to {:g} s of an INS; is the time in another unit? In "
        "milliseconds the header is t[ms]",
        logger.name, period, shortest_period, longest_period);
  const double span = logger.time.back() - logger.time.front(), slots = span / period;
  if (slots > most_rows || slots > most_empty * static_cast<double>(logger.time.size()))
    return error("{}: {} rows {:g} s apart span {:g} s; is one of the times wrong, or are these several recordings?",
                 logger.name, logger.time.size(), period, span);
  return {};
}

}  // namespace

Result<void> check_times(const InsRecording& recording) {
  for (const InsLogger& logger : recording.loggers)
    if (auto checked = check_times(logger); !checked) return checked;
  return {};
}

}  // namespace kinfer
