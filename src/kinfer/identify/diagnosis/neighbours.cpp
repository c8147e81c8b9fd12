// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/diagnosis/neighbours.hpp"

#include <algorithm>
#include <limits>

#include "kinfer/base/parallel.hpp"
#include "kinfer/identify/diagnosis/thresholds.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"
#include "kinfer/identify/structure/thresholds.hpp"
#include "kinfer/inertial/headings.hpp"
#include "kinfer/measurement/ins/ins_selection.hpp"

namespace kinfer::identify {
namespace {

constexpr double longest_excerpt = 60.0;  // [s] more rows cost time and change no choice

/// Fits of the pairs of all but one of the first `sensors` segments, and of these with each candidate behind them.
std::vector<PairFit> fit_candidates(const RecordedMotion& motion, std::size_t sensors, std::size_t replaced,
                                    const std::vector<std::size_t>& rows, HeadingReference headings, int threads) {
  std::vector<PairFit> pairs;
  for (std::size_t first = 0; first < sensors; ++first)
    for (std::size_t second = first + 1; second < motion.segments.size(); ++second)
      if (first != replaced && second != replaced) pairs.push_back({.first = first, .second = second});
  parallel_for(pairs.size(), threads,
               [&](std::size_t i) { pairs[i] = fit_pair(motion, pairs[i].first, pairs[i].second, rows, headings); });
  return pairs;
}

/// [nats per row] of the tree with each of the sensors behind the first `sensors` in the place of one of these; empty
/// if there is none.
std::vector<double> tree_lengths(const InsRecording& recording, std::size_t sensors, std::size_t replaced,
                                 int threads) {
  const auto motion = gyro_based_motion(recording, {}, threads);
  if (!motion) return {};
  const std::vector<std::size_t> rows = moving_rows(*motion);
  if (rows.size() < least_tree_rows) return {};
  const HeadingReference headings =
      all_have_magnetometers(recording) ? HeadingReference::magnetometers : HeadingReference::arbitrary;
  const std::vector<PairFit> pairs = fit_candidates(*motion, sensors, replaced, rows, headings, threads);
  std::vector<double> lengths;
  for (std::size_t c = 0; sensors + c < recording.sensors.size(); ++c) {
    std::vector<PairFit> with_candidate;
    for (PairFit pair : pairs) {
      if (pair.second >= sensors && pair.second != sensors + c) continue;
      if (pair.second >= sensors) pair.second = replaced;
      with_candidate.push_back(std::move(pair));
    }
    lengths.push_back(spanning_length(with_candidate, sensors));
  }
  return lengths;
}

}  // namespace

InsRecording busiest_minute(const InsRecording& recording, std::size_t sensor) {
  const InsSensor& of = recording.sensors[sensor];
  const auto time = recording.time(of);
  if (time.empty() || time.back() - time.front() <= longest_excerpt) return recording;
  double most = -1.0, begin = time.front(), sum = 0.0;
  std::size_t first = 0;
  const auto square_rate = [&](std::size_t row) {
    const Vec3 rate = of.angular_velocity.at(row);
    return rate.allFinite() ? rate.squaredNorm() : 0.0;
  };
  for (std::size_t row = 0; row < time.size(); ++row) {
    sum += square_rate(row);
    while (time[row] - time[first] > longest_excerpt) sum -= square_rate(first++);
    if (sum > most) most = sum, begin = time[first];
  }
  return within(recording, begin, begin + longest_excerpt);
}

double tree_length(const InsRecording& recording, int threads) {
  const auto ordered = order_segments(recording, {}, {}, threads);
  if (!ordered) return std::numeric_limits<double>::infinity();
  double length = 0.0;
  for (std::size_t s = 0; s < ordered->tree.parent.size(); ++s)
    if (ordered->tree.parent[s]) length += ordered->tree.pair(s, *ordered->tree.parent[s]).distance;
  return length;
}

double AxesChoice::lead() const {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < log_likelihood.size(); ++c)
    if (c != candidate) least = std::min(least, log_likelihood[candidate] - log_likelihood[c]);
  return least;
}

AxesChoice choose_axes(const InsRecording& recording, std::size_t sensor, const std::vector<AxesCandidate>& candidates,
                       int threads) {
  InsRecording all = recording;
  for (const AxesCandidate& candidate : candidates) all.sensors.push_back(candidate.sensor);
  const InsRecording excerpt = busiest_minute(all, sensor);
  const auto lengths = tree_lengths(excerpt, recording.sensors.size(), sensor, threads);
  const auto time = excerpt.time(excerpt.sensors[sensor]);
  const double independent_rows = independent_rows_a_second * (time.back() - time.front());
  AxesChoice choice;
  for (std::size_t c = 0; c < candidates.size(); ++c)
    choice.log_likelihood.push_back(candidates[c].log_likelihood -
                                    (lengths.empty() ? 0.0 : independent_rows * lengths[c]));
  choice.candidate =
      static_cast<std::size_t>(std::ranges::max_element(choice.log_likelihood) - choice.log_likelihood.begin());
  choice.tree_gain =
      lengths.empty() ? std::numeric_limits<double>::quiet_NaN() : lengths[0] - lengths[choice.candidate];
  return choice;
}

}  // namespace kinfer::identify
