// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/diagnosis/repeated_rows.hpp"

#include <cmath>

namespace kinfer {
namespace {

constexpr std::size_t longest_run = 12;  // rows alike beyond which the instrument measured nothing new
constexpr double equal_digits = 2e-6;    // of a value: what remains of the digits that a file holds
constexpr double clear_bend = 20.0;      // of that: less, and a smooth signal without noise looks straight

/// Marks runs of at most `longest_run` rows in a row that are `flat`; returns their share of all rows but longer runs.
double mark_short_runs(const std::vector<bool>& flat, std::vector<bool>& marked) {
  marked.assign(flat.size(), false);
  std::size_t rows = 0, count = 0;
  for (std::size_t begin = 0; begin < flat.size();) {
    std::size_t end = begin;
    while (end < flat.size() && flat[end] == flat[begin]) ++end;
    const bool is_long = flat[begin] && end - begin > longest_run;
    if (!is_long) rows += end - begin;
    if (flat[begin] && !is_long) {
      count += end - begin;
      for (std::size_t k = begin; k < end; ++k) marked[k] = true;
    }
    begin = end;
  }
  return rows > 0 ? static_cast<double>(count) / static_cast<double>(rows) : 0.0;
}

}  // namespace

SampleOrigin sample_origin(const TriadColumns& triad) {
  SampleOrigin origin;
  const std::size_t rows = triad.axis[0].size();
  if (rows < 3) return origin;
  std::vector<bool> same(rows, false), straight(rows, false);
  std::size_t bent = 0, nearly_straight = 0;
  for (std::size_t k = 1; k < rows; ++k) {
    const Vec3 before = triad.at(k - 1), now = triad.at(k);
    if (!before.allFinite() || !now.allFinite()) continue;
    const double resolution = equal_digits * now.cwiseAbs().maxCoeff();
    same[k] = (now - before).cwiseAbs().maxCoeff() <= 0.0;
    if (same[k] || k + 1 >= rows || !triad.at(k + 1).allFinite()) continue;
    const Vec3 bend = now - 0.5 * (before + triad.at(k + 1));
    straight[k] = bend.cwiseAbs().maxCoeff() <= resolution;
    if (!straight[k]) ++(bend.cwiseAbs().maxCoeff() > clear_bend * resolution ? bent : nearly_straight);
  }
  origin.repeated_share = mark_short_runs(same, origin.repeated);
  if (bent > 4 * nearly_straight) origin.interpolated_share = mark_short_runs(straight, origin.interpolated);
  return origin;
}

}  // namespace kinfer
