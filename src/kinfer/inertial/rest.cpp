#include "kinfer/inertial/rest.hpp"

#include <cmath>

namespace kinfer {
namespace {

constexpr double shortest_listed = 1.0;  // [s] shorter rests say little about a bias
constexpr double margin = 0.1;           // [s] of a rest's ends, where the detector lags

/// Mean and standard deviation over the rows of a rest whose numbers can be used.
void summarise(const InsSensor& sensor, std::span<const double> time, Rest& rest) {
  Vec3 rate = Vec3::Zero(), rate2 = Vec3::Zero(), force = Vec3::Zero(), force2 = Vec3::Zero();
  double rates = 0.0, forces = 0.0;
  for (std::size_t row = rest.first_row; row <= rest.last_row; ++row) {
    const InsSample s = sample(sensor, time, row);
    if (s.has_rate) rate += s.rate, rate2 += s.rate.cwiseAbs2(), rates += 1.0;
    if (s.has_acceleration) force += s.acceleration, force2 += s.acceleration.cwiseAbs2(), forces += 1.0;
  }
  if (rates <= 1.0 || forces <= 1.0) return;
  rest.rate = rate / rates;
  rest.acceleration = force / forces;
  rest.rate_sd = (rate2 / rates - rest.rate.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
  rest.acceleration_sd = (force2 / forces - rest.acceleration.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
}

/// Rows of [begin, end] without the margins; nothing where too little is left.
void add_rest(const InsSensor& sensor, std::span<const double> time, std::size_t first, std::size_t last,
              std::vector<Rest>& found) {
  while (first < last && time[first] < time[last] && time[last] - time[first] > shortest_listed &&
         sensor.faults[first] & (rate_missing | acceleration_missing))
    ++first;
  Rest rest{.first_row = first, .last_row = last};
  const double begin = time[first] + margin, end = time[last] - margin;
  while (rest.first_row < last && time[rest.first_row] < begin) ++rest.first_row;
  while (rest.last_row > first && time[rest.last_row] > end) --rest.last_row;
  if (rest.first_row >= rest.last_row) return;
  rest.begin = time[rest.first_row];
  rest.end = time[rest.last_row];
  if (rest.seconds() < shortest_listed) return;
  summarise(sensor, time, rest);
  found.push_back(rest);
}

}  // namespace

void RestDetector::add(const InsSample& sample, double dt, const RestOptions& options) {
  if (!sample.has_rate || !sample.has_acceleration || sample.rate_clipped) {
    still = 0.0;
    return;
  }
  fast_rate.add(sample.rate, dt, options.noise_time);
  slow_rate.add(sample.rate, dt, options.mean_time);
  fast_acceleration.add(sample.acceleration, dt, options.noise_time);
  slow_acceleration.add(sample.acceleration, dt, options.mean_time);
  const bool keeps_to_mean =
      (fast_rate.value - slow_rate.value).norm() < options.rate_threshold &&
      (fast_acceleration.value - slow_acceleration.value).norm() < options.acceleration_threshold;
  if (!keeps_to_mean) {  // begin a new mean, so that motion is forgotten at once when it ends
    slow_rate = {fast_rate.value, dt};
    slow_acceleration = {fast_acceleration.value, dt};
  }
  const bool quiet = keeps_to_mean && slow_rate.value.cwiseAbs().maxCoeff() < options.largest_bias;
  still = quiet ? still + dt : 0.0;
}

std::vector<Rest> rests(const InsSensor& sensor, std::span<const double> time, const RestOptions& options) {
  std::vector<Rest> found;
  RestDetector detector;
  const double usual = typical_period(time);
  std::size_t first = 0;
  bool resting = false;
  for (std::size_t row = 0; row < time.size(); ++row) {
    const double dt = row > 0 ? time[row] - time[row - 1] : usual;
    const InsSample s = sample(sensor, time, row);
    if (!s.has_rate && !s.has_acceleration && dt < options.mean_time) continue;  // another sensor's row
    if (dt > gap_factor * usual && dt > options.noise_time) detector = {};
    detector.add(s, std::min(dt, options.mean_time), options);
    const bool still = detector.at_rest(options);
    if (resting && !still) add_rest(sensor, time, first, row - 1, found);
    if (!resting && still) {
      first = row;
      while (first > 0 && time[row] - time[first - 1] < detector.still) --first;
    }
    resting = still;
  }
  if (resting) add_rest(sensor, time, first, time.size() - 1, found);
  return found;
}

RestBias bias_at_rest(std::span<const Rest> rests) {
  RestBias bias;
  for (const Rest& rest : rests) bias.mean += rest.seconds() * rest.rate, bias.seconds += rest.seconds();
  if (bias.seconds <= 0.0) return bias;
  bias.mean /= bias.seconds;
  for (const Rest& rest : rests) bias.spread += rest.seconds() * (rest.rate - bias.mean).cwiseAbs2();
  bias.spread = (bias.spread / bias.seconds).cwiseSqrt();
  return bias;
}

}  // namespace kinfer
