// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/diagnosis/copied_rows.hpp"

#include <bit>
#include <cstdint>
#include <unordered_map>

#include "kinfer/identify/diagnosis/thresholds.hpp"

namespace kinfer::identify {
namespace {

/// One hash of each row of a logger, over accelerometers and gyroscopes of all its sensors (Fowler, Noll and Vo).
std::vector<std::uint64_t> row_hashes(const InsRecording& recording, std::size_t logger) {
  constexpr std::uint64_t basis = 14695981039346656037U, prime = 1099511628211U;
  std::vector<std::uint64_t> hashes(recording.loggers[logger].time.size(), basis);
  for (const InsSensor& sensor : recording.sensors) {
    if (sensor.logger != logger) continue;
    for (const TriadColumns* triad : {&sensor.acceleration, &sensor.angular_velocity})
      for (const auto& axis : triad->axis)
        for (std::size_t row = 0; row < axis.size(); ++row)
          hashes[row] = (hashes[row] ^ std::bit_cast<std::uint32_t>(axis[row])) * prime;
  }
  return hashes;
}

struct CopiedRows {
  std::size_t count = 0, first = 0, original = 0;  ///< first: the copy's first row; original: that which it copies
};

/// Of all stretches of changing rows that repeat earlier ones in their order.
CopiedRows copied_rows(const std::vector<std::uint64_t>& hashes) {
  CopiedRows copied;
  std::unordered_map<std::uint64_t, std::size_t> first_row;
  std::size_t length = 0, changes = 0;
  const auto end_stretch = [&](std::size_t end, std::size_t original_end) {
    if (changes >= min_copied_rows) {
      if (copied.count == 0) copied.first = end - length, copied.original = original_end - length;
      copied.count += length;
    }
    length = changes = 0;
  };
  std::size_t expected = hashes.size();  // the row that continues the stretch
  for (std::size_t row = 0; row < hashes.size(); ++row) {
    const bool changes_here = row == 0 || hashes[row] != hashes[row - 1];
    if (length > 0 && expected < row && hashes[expected] == hashes[row]) {
      ++length, ++expected, changes += changes_here ? 1 : 0;
      continue;
    }
    end_stretch(row, expected);
    const auto [earlier, is_new] = first_row.try_emplace(hashes[row], row);
    if (!is_new) length = 1, changes = 1, expected = earlier->second + 1;
  }
  end_stretch(hashes.size(), expected);
  return copied;
}

}  // namespace

Result<void> refuse_copied_rows(const InsRecording& recording) {
  for (std::size_t logger = 0; logger < recording.loggers.size(); ++logger) {
    const std::vector<double>& time = recording.loggers[logger].time;
    const CopiedRows copied = copied_rows(row_hashes(recording, logger));
    if (static_cast<double>(copied.count) <= max_copied_share * static_cast<double>(time.size())) continue;
    return error(
        "{}: {} of {} rows, from {:.2f} s on, are copies of earlier ones, from {:.2f} s on: a log that was joined with "
        "itself would count twice; leave the copy out",
        recording.loggers[logger].name, copied.count, time.size(), time[copied.first], time[copied.original]);
  }
  return {};
}

}  // namespace kinfer::identify
