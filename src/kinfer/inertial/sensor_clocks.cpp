// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/sensor_clocks.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "kinfer/base/parallel.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/inertial/clock_offset.hpp"
#include "kinfer/inertial/rest/rest.hpp"
#include "kinfer/inertial/thresholds.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;
using Products = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;  // one row a tick

constexpr Index min_ticks = 200;  // of a comparison

/// Common sampling instants of all sensors after the loggers have been aligned.
struct Ticks {
  double begin = 0.0, period = 0.0;
  Index count = 0;
};

/// ω_i ω_k of a sensor at the ticks, missing measurements interpolated linearly.
Products products_of(const InsSensor& sensor, std::span<const double> time, double shift, const Ticks& ticks) {
  const Vec3 bias = bias_at_rest(rest_periods(sensor, time)).mean;
  Products products(ticks.count, 6);
  Vec3 before = Vec3::Zero(), after = Vec3::Zero();
  double time_before = -1e300, time_after = -1e300;
  std::size_t row = 0;
  for (Index i = 0; i < ticks.count; ++i) {
    const double tick = ticks.begin + ticks.period * static_cast<double>(i);
    while (time_after < tick && row < time.size()) {
      const InsSample s = sample(sensor, time, row++);
      if (!s.has_angular_velocity) continue;
      time_before = std::exchange(time_after, s.time + shift);
      before = std::exchange(after, Vec3(s.angular_velocity - bias));
      if (time_before < -1e299) before = after;
    }
    const double span = time_after - time_before;
    const double share = span > 0.0 ? std::clamp((tick - time_before) / span, 0.0, 1.0) : 1.0;
    const Vec3 w = before + share * (after - before);
    products.row(i) << w.x() * w.x(), w.y() * w.y(), w.z() * w.z(), w.x() * w.y(), w.y() * w.z(), w.z() * w.x();
  }
  return products;
}

/// A window of one sensor's products, centred and whitened; directions without excitation are dropped. nullopt if there
/// is no excitation at all.
std::optional<MatrixXd> whitened(const Products& products, Index first, Index count) {
  if (first < 0 || first + count > products.rows()) return std::nullopt;
  MatrixXd x = products.middleRows(first, count);
  x.rowwise() -= x.colwise().mean().eval();
  const SymmetricEigen spread = symmetric_eigen(gram(x) / static_cast<double>(count));
  constexpr double still = 1e-8, negligible = 1e-4;  // [(rad/s)⁴]; of the largest variance
  const double largest = spread.values[5];
  if (!(largest > still)) return std::nullopt;
  const Index kept = (spread.values.array() > negligible * largest).count();
  const VectorXd scale = spread.values.tail(kept).cwiseSqrt().cwiseInverse();
  return product(x, spread.vectors.rightCols(kept)) * scale.asDiagonal();
}

/// ρ² of the best pair of forms. Near its maximum it is a parabola in the lag, whereas its logarithm has a cusp.
double squared_correlation(const MatrixXd& a, const MatrixXd& b) {
  const MatrixXd mixed = transposed_times(a, b) / static_cast<double>(a.rows());
  return symmetric_eigen(times_transposed(mixed, mixed)).values.tail<1>()[0];
}

/// Mutual information [nats] of the forms, assuming Gaussian distributions.
double mutual_information(double square) {
  return -0.5 * std::log(1.0 - std::min(square, 1.0 - 1e-12));
}

struct Lag {
  double seconds = 0.0;    ///< to be added to the second sensor's times
  double agreement = 0.0;  ///< [nats] at this lag
  bool found = false;
};

/// Compares `count` ticks of a, starting at `first`, with those of b shifted by `middle` ± `reach` ticks.
Lag best_lag(const Products& a, const Products& b, Index first, Index count, Index middle, Index reach, double period) {
  const auto fixed = whitened(a, first, count);
  if (!fixed) return {};
  std::vector<double> at;  // ρ² from middle - reach on
  for (Index lag = middle - reach; lag <= middle + reach; ++lag) {
    const auto moved = whitened(b, first - lag, count);
    at.push_back(moved ? squared_correlation(*fixed, *moved) : 0.0);
  }
  const auto best = std::ranges::max_element(at) - at.begin();
  if (best == 0 || best + 1 == std::ssize(at)) return {};
  const auto k = static_cast<std::size_t>(best);
  const double bend = at[k - 1] - 2.0 * at[k] + at[k + 1];
  const double vertex = bend < 0.0 ? 0.5 * (at[k - 1] - at[k + 1]) / bend : 0.0;
  return {.seconds = (static_cast<double>(middle - reach + best) + std::clamp(vertex, -1.0, 1.0)) * period,
          .agreement = mutual_information(at[k]),
          .found = mutual_information(at[k]) > inertial::min_agreement};
}

/// b's products at the times of a's ticks from `first` on, where b's clock is corrected by `lag` [ticks] in the middle
/// of all ticks and by `drift`; linear between ticks. nullopt beyond b's ends.
std::optional<Products> moved(const Products& b, Index first, Index count, double lag, double drift) {
  const double middle = 0.5 * static_cast<double>(b.rows());
  Products result(count, 6);
  for (Index i = 0; i < count; ++i) {
    const double tick = static_cast<double>(first + i), at = tick - lag - drift * (tick - middle);
    const auto before = static_cast<Index>(std::floor(at));
    if (before < 0 || before + 1 >= b.rows()) return std::nullopt;
    const double share = at - static_cast<double>(before);
    result.row(i) = (1.0 - share) * b.row(before) + share * b.row(before + 1);
  }
  return result;
}

/// Lag at the middle of all ticks [ticks] and drift with the squared correlation that they leave.
struct LagAndDrift {
  double lag = 0.0, drift = 0.0, square = 0.0;
};

/// The best lag and drift for a window of a, on a grid about `start` and then between its points. In a window of n
/// ticks a drift of 1 / n moves the ends by half a tick.
LagAndDrift best_lag_and_drift(const Products& a, const Products& b, Index first, Index count, double start) {
  const auto fixed = whitened(a, first, count);
  if (!fixed) return {};
  const auto square_at = [&](double lag, double drift) {
    const auto other = moved(b, first, count, lag, drift);
    const auto white = other ? whitened(*other, 0, count) : std::nullopt;
    return white ? squared_correlation(*fixed, *white) : 0.0;
  };
  LagAndDrift best{start, 0.0, square_at(start, 0.0)};
  const auto consider = [&](double lag, double drift) {
    if (const double square = square_at(lag, drift); square > best.square) best = {lag, drift, square};
  };
  const double middle = 0.5 * static_cast<double>(b.rows()), step = 1.0 / static_cast<double>(count);
  // What turned the window most may lie beside its middle: the lag there is that of `start` for any drift.
  const double from_middle = std::abs(static_cast<double>(first) + 0.5 * static_cast<double>(count) - middle) +
                             0.5 * static_cast<double>(count);
  for (double drift = step; drift <= inertial::largest_clock_drift; drift += step)
    for (const double signed_drift : {drift, -drift})
      for (double shift = -drift * from_middle; shift <= drift * from_middle + 0.5; shift += 1.0)
        consider(start + shift, signed_drift);
  for (double part = 0.5; part > 0.05; part *= 0.5) {
    const LagAndDrift now = best;
    for (const double lag : {-part, 0.0, part})
      for (const double drift : {-part, 0.0, part}) consider(now.lag + lag, now.drift + drift * step);
  }
  return best;
}

struct PairLag {
  std::size_t first = 0, second = 0;
  Lag lag;
};

class ClockComparison {
 public:
  ClockComparison(const InsRecording& recording, const ClockOptions& options, int threads)
      : recording_(recording), options_(options), threads_(threads) {
    for (std::size_t logger = 0; logger < recording.loggers.size(); ++logger) shift_.push_back(shift_of(logger));
    const auto begin = [&](std::size_t l) { return recording.loggers[l].time.front() + shift_[l]; };
    const auto end = [&](std::size_t l) { return recording.loggers[l].time.back() + shift_[l]; };
    double first = begin(0), last = end(0);
    for (std::size_t l = 1; l < shift_.size(); ++l) first = std::max(first, begin(l)), last = std::min(last, end(l));
    ticks_ = {first, 1.0 / options.sampling_rate,
              std::max<Index>(0, static_cast<Index>((last - first) * options.sampling_rate))};
    products_.resize(recording.sensors.size());
    parallel_for(products_.size(), threads, [&](std::size_t s) {
      const InsSensor& sensor = recording.sensors[s];
      products_[s] = products_of(sensor, recording.time(sensor), shift_[sensor.logger], ticks_);
    });
  }

  Index reach() const { return static_cast<Index>(std::ceil(options_.max_offset / ticks_.period)); }
  double shift(std::size_t sensor) const { return shift_[recording_.sensors[sensor].logger]; }
  double length() const { return ticks_.period * static_cast<double>(ticks_.count); }
  double middle() const { return ticks_.begin + 0.5 * length(); }

  /// All pairs, over the time window with the most rotation.
  std::vector<PairLag> compare_all_pairs() const {
    std::vector<PairLag> pairs;
    for (std::size_t i = 0; i < products_.size(); ++i)
      for (std::size_t j = i + 1; j < products_.size(); ++j) pairs.push_back({i, j, {}});
    const Index count = window_count(), first = most_active_window(count);
    parallel_for(pairs.size(), threads_,
                 [&](std::size_t p) { pairs[p].lag = compare(pairs[p].first, pairs[p].second, first, count, 0); });
    return pairs;
  }

  /// Offset at the middle and drift of a pair.
  ClockCorrection line(const PairLag& pair) const {
    const ClockCorrection near = line_of_window(pair);
    return length() < options_.min_drift_duration ? near : line_of_windows(pair, near);
  }

 private:
  /// From the window with the most rotation. A drift that explains it no better than chance would is none.
  ClockCorrection line_of_window(const PairLag& pair) const {
    const ClockCorrection constant{.offset = pair.lag.seconds, .drift = 0.0, .middle = middle()};
    const Index margin =
        reach() + static_cast<Index>(inertial::largest_clock_drift * static_cast<double>(ticks_.count));
    const Index count = std::min(window_count(), ticks_.count - 2 * margin);
    if (count < min_ticks) return constant;
    const Index first = std::clamp<Index>(most_active_window(window_count()), margin, ticks_.count - count - margin);
    const LagAndDrift found = best_lag_and_drift(products_[pair.first], products_[pair.second], first, count,
                                                 pair.lag.seconds / ticks_.period);
    const double samples = static_cast<double>(count) * ticks_.period / inertial::independent_rate_time,
                 gain = samples * (mutual_information(found.square) - pair.lag.agreement);
    if (gain < inertial::min_drift_gain) return constant;
    return {.offset = found.lag * ticks_.period, .drift = found.drift, .middle = middle()};
  }

  /// From windows over the whole recording, about `near` (Theil 1950, Sen 1968).
  ClockCorrection line_of_windows(const PairLag& pair, const ClockCorrection& near) const {
    const Index count = window_count();
    const auto windows = std::min<std::size_t>(inertial::max_windows, static_cast<std::size_t>(ticks_.count / count));
    std::vector<double> at, offset;
    for (std::size_t w = 0; w < windows; ++w) {
      const auto first = static_cast<Index>(static_cast<double>(ticks_.count - count) * static_cast<double>(w) /
                                            static_cast<double>(std::max<std::size_t>(1, windows - 1)));
      const double centre =
          ticks_.begin + ticks_.period * (static_cast<double>(first) + 0.5 * static_cast<double>(count));
      const Lag lag = compare(pair.first, pair.second, first, count,
                              static_cast<Index>(std::round(near.shift_at(centre) / ticks_.period)));
      if (!lag.found) continue;
      at.push_back(centre);
      offset.push_back(lag.seconds);
    }
    std::vector<double> slopes, levels;
    for (std::size_t i = 0; i < at.size(); ++i)
      for (std::size_t j = i + 1; j < at.size(); ++j)
        if (at[j] - at[i] > inertial::min_window_distance * length())
          slopes.push_back((offset[j] - offset[i]) / (at[j] - at[i]));
    if (slopes.empty()) return near;
    const double drift = median(slopes);
    for (std::size_t i = 0; i < at.size(); ++i) levels.push_back(offset[i] - drift * (at[i] - middle()));
    return {.offset = median(levels), .drift = drift, .middle = middle()};
  }

  /// Shift of a logger to the first one: by correlation if reliable, else by equal start times.
  double shift_of(std::size_t logger) const {
    if (share_clock(recording_, 0, logger)) return 0.0;
    for (std::size_t before = 0; before < logger; ++before)
      if (share_clock(recording_, before, logger)) return shift_[before];
    const ClockOffset offset = estimate_clock_offset(recording_, 0, logger);
    return offset.correlation > inertial::min_logger_correlation
               ? offset.seconds
               : recording_.loggers[0].time.front() - recording_.loggers[logger].time.front();
  }

  Index window_count() const {
    return std::min(static_cast<Index>(options_.window / ticks_.period),
                    std::max<Index>(0, ticks_.count - 2 * reach()));
  }

  Lag compare(std::size_t a, std::size_t b, Index first, Index count, Index middle) const {
    if (count < min_ticks) return {};
    first = std::clamp<Index>(first, std::max<Index>(0, middle + reach()),
                              std::max<Index>(0, ticks_.count - count + std::min<Index>(0, middle - reach())));
    return best_lag(products_[a], products_[b], first, count, middle, reach(), ticks_.period);
  }

  Index most_active_window(Index count) const {
    VectorXd turning = VectorXd::Zero(ticks_.count);
    for (const Products& p : products_) turning += p.leftCols<3>().rowwise().sum();
    double best = -1.0;
    Index first = reach();
    for (Index at = reach(); at + count + reach() <= ticks_.count; at += std::max<Index>(1, count / 4))
      if (const double sum = turning.segment(at, count).sum(); sum > best) best = sum, first = at;
    return first;
  }

  const InsRecording& recording_;
  const ClockOptions& options_;
  int threads_;
  std::vector<double> shift_;  // of each logger, to the first
  Ticks ticks_;
  std::vector<Products> products_;
};

/// Kruskal 1956, strongest agreement first.
std::vector<PairLag> maximum_spanning_tree(std::vector<PairLag> pairs, std::size_t sensors) {
  std::ranges::stable_sort(pairs, std::greater{}, [](const PairLag& c) { return c.lag.agreement; });
  std::vector<std::size_t> group(sensors);
  std::iota(group.begin(), group.end(), std::size_t{0});
  std::vector<PairLag> tree;
  for (const PairLag& pair : pairs) {
    const std::size_t from = group[pair.second], to = group[pair.first];
    if (!pair.lag.found || from == to) continue;
    tree.push_back(pair);
    std::ranges::replace(group, from, to);
  }
  return tree;
}

/// Of the first logger, unless none of its sensors agrees with any: a base that stands still tells no time.
std::size_t choose_reference(const InsRecording& recording, const std::vector<PairLag>& tree) {
  std::size_t best = 0, best_of_first = 0;
  double strongest = -1.0, strongest_of_first = 0.0;
  for (std::size_t s = 0; s < recording.sensors.size(); ++s) {
    double sum = 0.0;
    for (const PairLag& pair : tree)
      if (pair.first == s || pair.second == s) sum += pair.lag.agreement;
    if (sum > strongest) best = s, strongest = sum;
    if (recording.sensors[s].logger == 0 && sum > strongest_of_first) best_of_first = s, strongest_of_first = sum;
  }
  return strongest_of_first > 0.0 ? best_of_first : best;
}

}  // namespace

std::vector<ClockEstimate> estimate_sensor_clocks(const InsRecording& recording, const ClockOptions& options,
                                                  int threads) {
  const ClockComparison comparison(recording, options, threads);
  const std::vector<PairLag> tree = maximum_spanning_tree(comparison.compare_all_pairs(), recording.sensors.size());
  std::vector<ClockEstimate> clocks(recording.sensors.size());
  for (std::size_t s = 0; s < clocks.size(); ++s) {
    clocks[s].correction.middle = comparison.middle() - comparison.shift(s);
    clocks[s].correction.offset = comparison.shift(s);
  }
  std::vector<std::size_t> reached{choose_reference(recording, tree)};
  clocks[reached.front()].known = true;
  for (std::size_t next = 0; next < reached.size(); ++next)
    for (const PairLag& pair : tree) {
      const std::size_t at = reached[next];
      if (pair.first != at && pair.second != at) continue;
      const std::size_t other = pair.first == at ? pair.second : pair.first;
      if (clocks[other].known) continue;
      const ClockCorrection line = comparison.line(pair);
      const double sign = pair.second == other ? 1.0 : -1.0;
      ClockCorrection& correction = clocks[other].correction;
      correction.offset =
          comparison.shift(other) + clocks[at].correction.offset - comparison.shift(at) + sign * line.offset;
      correction.drift = clocks[at].correction.drift + sign * line.drift;
      clocks[other].known = true;
      reached.push_back(other);
    }
  std::vector<ClockCorrection> known;
  for (const ClockEstimate& clock : clocks)
    if (clock.known) known.push_back(clock.correction);
  if (const double drift = common_drift(known); std::abs(drift) > 0.0)
    for (ClockEstimate& clock : clocks)
      if (clock.known) clock.correction = without_drift(clock.correction, drift, comparison.middle());
  return clocks;
}

double common_drift(std::span<const ClockCorrection> corrections) {
  const auto votes_for = [&](double drift) {
    double sum = 0.0;
    for (const ClockCorrection& c : corrections) {
      const double off = (c.drift - drift) / inertial::usual_clock_drift;
      sum += std::exp(-0.5 * off * off);
    }
    return sum;
  };
  double best = 0.0, most = 0.0;
  for (const ClockCorrection& c : corrections)
    if (const double votes = votes_for(c.drift); votes > most) best = c.drift, most = votes;
  const bool is_reference_odd = std::abs(best) > inertial::odd_clock_drift && most > votes_for(0.0) + 0.5;
  return is_reference_odd ? best : 0.0;
}

ClockCorrection without_drift(const ClockCorrection& correction, double drift, double middle) {
  const auto machine_time = [&](double t) { return middle + (t + correction.shift_at(t) - middle) / (1.0 + drift); };
  return {.offset = machine_time(correction.middle) - correction.middle,
          .drift = (1.0 + correction.drift) / (1.0 + drift) - 1.0,
          .middle = correction.middle};
}

}  // namespace kinfer
