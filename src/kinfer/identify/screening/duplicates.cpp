// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/duplicates.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer::identify {
namespace {

constexpr float equal_digits = 1e-5f;     // relative difference of a value that was printed twice
constexpr double min_equal_share = 0.95;  // of the rows that both have
constexpr std::size_t min_equal_rows = 50;

struct EqualRows {
  std::size_t equal = 0, compared = 0;
  bool varies = false;  // a channel that never changes proves nothing
};

bool is_equal(float a, float b) {
  return std::abs(a - b) <= equal_digits * std::max(std::abs(a), std::abs(b));
}

void compare(const std::vector<float>& a, const std::vector<float>& b, EqualRows& rows) {
  for (std::size_t row = 0; row < std::min(a.size(), b.size()); ++row) {
    if (!std::isfinite(a[row]) || !std::isfinite(b[row])) continue;
    ++rows.compared;
    if (is_equal(a[row], b[row])) ++rows.equal;
    if (row > 0 && std::isfinite(a[row - 1]) && !is_equal(a[row], a[row - 1])) rows.varies = true;
  }
}

bool is_same_measurement(const TriadColumns& a, const TriadColumns& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    EqualRows rows;
    compare(a.axis[k], b.axis[k], rows);
    const auto needed = static_cast<std::size_t>(min_equal_share * static_cast<double>(rows.compared));
    if (!rows.varies || rows.compared < min_equal_rows || rows.equal < needed) return false;
  }
  return true;
}

}  // namespace

std::vector<Finding> duplicate_findings(const InsRecording& recording, const std::vector<std::size_t>& sensors) {
  std::vector<Finding> findings;
  for (std::size_t second = 1; second < sensors.size(); ++second)
    for (std::size_t first = 0; first < second; ++first) {
      const InsSensor &a = recording.sensors[sensors[first]], &b = recording.sensors[sensors[second]];
      if (!is_same_measurement(a.acceleration, b.acceleration) ||
          !is_same_measurement(a.angular_velocity, b.angular_velocity))
        continue;
      findings.push_back({.kind = FindingKind::duplicate_sensor,
                          .severity = Severity::fault,
                          .values = {{"first", a.name}, {"second", b.name}}});
      break;
    }
  return findings;
}

}  // namespace kinfer::identify
