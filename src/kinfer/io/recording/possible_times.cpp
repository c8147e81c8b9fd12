// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/possible_times.hpp"

#include <fmt/format.h>

#include "kinfer/measurement/ins/unit_check.hpp"

namespace kinfer {
namespace {

constexpr std::size_t few_rows = 3;    // that say nothing about the time between them
constexpr double most_empty = 1000.0;  // rows that could have been between those that are there, for each of them
constexpr double most_rows = 5e7;      // of a regular grid: a day of 500 Hz

Result<void> expect_sample_period(double period, const std::string& logger) {
  if (period <= longest_sample_period && period >= shortest_sample_period) return {};
  return error(
      "{}: rows are {:g} s apart, expected {:g} to {:g} s of an INS; is the time in another unit? In milliseconds the "
      "header is t[ms]",
      logger, period, shortest_sample_period, longest_sample_period);
}

Result<void> check_times(const InsLogger& logger) {
  const double period = sample_period(logger.time);
  if (logger.time.size() < few_rows) return {};
  if (auto possible = expect_sample_period(period * clock_unit(logger).value_or(1.0), logger.name); !possible)
    return possible;
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

Result<void> expect_seconds(std::span<const double> time, const std::string& logger) {
  return time.size() < few_rows ? Result<void>{} : expect_sample_period(sample_period(time), logger);
}

Result<void> expect_seconds(const InsRecording& recording) {
  for (const InsLogger& logger : recording.loggers)
    if (auto seconds = expect_seconds(logger.time, logger.name); !seconds) return seconds;
  return {};
}

}  // namespace kinfer
