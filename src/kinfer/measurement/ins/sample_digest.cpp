// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/ins/sample_digest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <set>
#include <vector>

namespace kinfer {
namespace {

using Row = std::array<std::int64_t, 6>;

constexpr std::size_t window_rows = 4, most_hashes = 512, digits = 12;
constexpr double force_step = 1e-3, rate_step = 1e-4;  // [m/s²], [rad/s] of rounding: digits of a file are finer
// Of 18 steps from row to row: what hardly scatters above the rounding may look alike in two recordings of one posture.
constexpr int least_changes = 12;
constexpr std::size_t most_chance_hits = 2;

std::uint64_t mixed(std::uint64_t x) {  // splitmix64
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

/// The sensor's complete samples, rounded.
std::vector<Row> rounded_samples(const InsSensor& sensor) {
  std::vector<Row> rows;
  if (!sensor.acceleration.present() || !sensor.angular_velocity.present()) return rows;
  for (std::size_t row = 0; row < sensor.rows(); ++row) {
    const Vec3 force = sensor.acceleration.at(row), rate = sensor.angular_velocity.at(row);
    if (!force.allFinite() || !rate.allFinite()) continue;
    Row all{};
    for (std::size_t k = 0; k < 3; ++k) {
      all[k] = std::llround(force[static_cast<Eigen::Index>(k)] / force_step);
      all[k + 3] = std::llround(rate[static_cast<Eigen::Index>(k)] / rate_step);
    }
    rows.push_back(all);
  }
  return rows;
}

int changes(const std::vector<Row>& rows, std::size_t first) {
  int count = 0;
  for (std::size_t row = first + 1; row < first + window_rows; ++row)
    for (std::size_t k = 0; k < 6; ++k) count += rows[row][k] != rows[row - 1][k];
  return count;
}

std::uint64_t hash_of(const std::vector<Row>& rows, std::size_t first) {
  constexpr unsigned unused_bits = 64U - 4U * digits;
  std::uint64_t hash = 0;
  for (std::size_t row = first; row < first + window_rows; ++row)
    for (const std::int64_t value : rows[row]) hash = mixed(hash ^ static_cast<std::uint64_t>(value));
  return hash >> unused_bits;
}

/// Those of a digest that is well formed.
std::vector<std::uint64_t> hashes_of(std::string_view digest) {
  std::vector<std::uint64_t> hashes;
  for (std::size_t at = 0; at + digits <= digest.size(); at += digits) {
    std::uint64_t hash = 0;
    const auto [end, error] = std::from_chars(digest.data() + at, digest.data() + at + digits, hash, 16);
    if (error != std::errc{} || end != digest.data() + at + digits) return {};
    hashes.push_back(hash);
  }
  std::ranges::sort(hashes);
  return hashes;
}

}  // namespace

std::string sample_digest(const InsRecording& recording) {
  std::set<std::uint64_t> smallest;
  for (const InsSensor& sensor : recording.sensors) {
    const std::vector<Row> rows = rounded_samples(sensor);
    for (std::size_t first = 0; first + window_rows <= rows.size(); ++first) {
      if (changes(rows, first) < least_changes) continue;
      smallest.insert(hash_of(rows, first));
      if (smallest.size() > most_hashes) smallest.erase(std::prev(smallest.end()));
    }
  }
  std::string digest;
  for (const std::uint64_t hash : smallest) fmt::format_to(std::back_inserter(digest), "{:012x}", hash);
  return digest;
}

double shared_samples(std::string_view a, std::string_view b) {
  const std::vector<std::uint64_t> one = hashes_of(a), other = hashes_of(b);
  if (one.empty() || other.empty()) return 0.0;
  const std::uint64_t limit = std::min(one.back(), other.back());
  std::vector<std::uint64_t> both;
  std::ranges::set_intersection(one, other, std::back_inserter(both));
  if (both.size() <= most_chance_hits) return 0.0;
  const auto kept = [&](const std::vector<std::uint64_t>& all) {
    return std::ranges::upper_bound(all, limit) - all.begin();
  };
  return static_cast<double>(both.size()) / static_cast<double>(std::min(kept(one), kept(other)));
}

}  // namespace kinfer
