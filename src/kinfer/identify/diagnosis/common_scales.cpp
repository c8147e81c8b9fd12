// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/diagnosis/common_scales.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "kinfer/base/constants.hpp"
#include "kinfer/base/parallel.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/diagnosis/thresholds.hpp"
#include "kinfer/inertial/diagnosis/section_fit.hpp"
#include "kinfer/inertial/rest/rest.hpp"
#include "kinfer/measurement/ins/ins_screening.hpp"

namespace kinfer::identify {
namespace {

/// ln of the mean of exp(x) over a list that is filled one by one.
class LogMean {
 public:
  void add(double x) { values_.push_back(x); }
  double value() const {
    const double most = std::ranges::max(values_);
    double sum = 0.0;
    for (const double x : values_) sum += std::exp(x - most);
    return most + std::log(sum / static_cast<double>(values_.size()));
  }

 private:
  std::vector<double> values_;
};

/// Mean and scatter of the readings, which is all that matters of them.
struct Readings {
  double mean = 0.0, square_scatter = 0.0, n = 0.0;
};

Readings summary_of(std::span<const double> readings) {
  Readings all;
  for (const double r : readings) all.mean += r / static_cast<double>(readings.size());
  for (const double r : readings) all.square_scatter += (r - all.mean) * (r - all.mean);
  all.n = static_cast<double>(readings.size());
  return all;
}

/// ln likelihood of the readings where gravity reads `mean`, their own errors having any of the sizes that there are.
double log_likelihood(const Readings& readings, double mean) {
  constexpr double ratio = 1.3;
  LogMean over_sizes;
  const double squares = readings.square_scatter + readings.n * (readings.mean - mean) * (readings.mean - mean);
  for (double sd = least_reading_error; sd < largest_reading_error; sd *= ratio)
    over_sizes.add(-readings.n * std::log(sd) - 0.5 * squares / (sd * sd));
  return over_sizes.value();
}

/// The same over the places on Earth, each times a factor.
double log_likelihood_on_earth(const Readings& readings, double factor) {
  constexpr int places = 15;
  LogMean over_places;
  for (int i = 0; i < places; ++i)
    over_places.add(log_likelihood(
        readings, factor * (least_gravity + (largest_gravity - least_gravity) * i / static_cast<double>(places - 1))));
  return over_places.value();
}

/// Too much or too little, any size as likely as its double.
struct FactorLikelihood {
  double log_likelihood = 0.0;
  double mean_square = 0.0;  ///< of the scale error, given the readings
};

FactorLikelihood likelihood_of_factors(const Readings& readings) {
  constexpr double ratio = 1.1;
  std::vector<double> scales, logs;
  LogMean over_factors;
  for (double size = least_force_scale; size < largest_force_scale; size *= ratio)
    for (const double scale : {size, -size}) {
      scales.push_back(scale), logs.push_back(log_likelihood_on_earth(readings, 1.0 + scale));
      over_factors.add(logs.back());
    }
  FactorLikelihood all{over_factors.value(), 0.0};
  for (std::size_t i = 0; i < scales.size(); ++i)
    all.mean_square +=
        scales[i] * scales[i] * std::exp(logs[i] - all.log_likelihood) / static_cast<double>(scales.size());
  return all;
}

/// [m/s²] Mean over the rests; none where the sensor never rests.
std::optional<double> gravity_at_rest(const InsSensor& sensor, std::span<const double> time) {
  double sum = 0.0, seconds = 0.0;
  for (const RestPeriod& rest : rest_periods(sensor, time))
    sum += rest.seconds() * rest.acceleration.norm(), seconds += rest.seconds();
  return seconds > 0.0 ? std::optional(sum / seconds) : std::nullopt;
}

void mend_force_scale(MendedLog& log) {
  std::vector<double> readings;
  for (const InsSensor& sensor : log.log().sensors)
    if (const auto reading = gravity_at_rest(sensor, log.log().time(sensor))) readings.push_back(*reading);
  if (readings.empty()) return;
  const ForceScale scale = common_force_scale(readings);
  if (scale.log_odds < log_force_scale_odds) return;  // the readings speak against one
  if (scale.log_odds < 0.0) {
    log.scales.accelerometer.sd = scale.possible;  // left to the fit, and to the lengths' standard deviations
    return;
  }
  log.scales.accelerometer = {scale.factor, scale.sd};
  for (InsSensor& sensor : log.edit().sensors) {
    transform(sensor.acceleration, 1.0 / scale.factor, Mat3::Identity());
    flag_faults(sensor);
  }
  log.findings.push_back(
      {.kind = FindingKind::force_scale,
       .severity = Severity::warning,
       .values = {{"scale", scale.factor - 1.0}, {"sd", scale.sd}, {"gravity", summary_of(readings).mean}},
       .applied = true});
}

/// The signals of all sensors by a clock that runs `rate` times slower than the log's.
std::vector<SectionSignals> signals_of(const InsRecording& recording, double rate, int threads) {
  std::vector<std::optional<SectionSignals>> all(recording.sensors.size());
  parallel_for(all.size(), threads, [&](std::size_t s) {
    const InsSensor& sensor = recording.sensors[s];
    const auto logged = recording.time(sensor);
    std::vector<double> time(logged.begin(), logged.end());
    for (double& t : time) t /= rate;
    all[s] = section_signals(sensor.acceleration, sensor.angular_velocity, time, max_quiet_rate);
  });
  std::vector<SectionSignals> found;
  for (auto& signals : all)
    if (signals) found.push_back(std::move(*signals));
  return found;
}

/// [nats] By how much one factor of the rates explains the sensors better than another; each sensor counts up to a
/// limit.
double gain_over(const std::vector<SectionSignals>& sensors, double factor, double other, int threads) {
  std::vector<double> gains(sensors.size());
  parallel_for(sensors.size(), threads, [&](std::size_t s) {
    gains[s] = factor_likelihood(sensors[s], factor) - factor_likelihood(sensors[s], other);
  });
  double sum = 0.0;
  for (const double gain : gains) sum += std::clamp(gain, -max_sensor_vote, max_sensor_vote);
  return sum;
}

/// The most likely factor that rates must be divided by, up to `most` times either way, on a grid and then between its
/// neighbours.
double best_divisor(const std::vector<SectionSignals>& sensors, double most, int threads) {
  constexpr double step = 0.07, finest = 2e-3;  // of ln factor
  double best = 0.0, most_gain = 0.0;
  const auto consider = [&](double log_factor) {
    if (const double gain = gain_over(sensors, std::exp(-log_factor), 1.0, threads); gain > most_gain)
      best = log_factor, most_gain = gain;
  };
  for (double x = step; x <= std::log(most); x += step) consider(x), consider(-x);
  for (double width = 0.5 * step; width > finest; width *= 0.5) {
    const double middle = best;
    consider(middle - width), consider(middle + width);
  }
  return std::exp(best);
}

/// By how much the clock runs too fast, or all rates are too large: sections are as long as they should be only by the
/// right clock, so the factor is found again by the clock that it says.
struct RateFactor {
  double factor = 1.0;
  double gain = 0.0;          ///< [nats] over the log as it is
  double over_no_rate = 0.0;  ///< [nats] over no rotation
};

RateFactor find_rate_factor(const InsRecording& recording, int threads) {
  constexpr int most_rounds = 4;
  constexpr double largest = 20.0, near = 2.0, settled = 0.01, no_rate = 1e-3;
  RateFactor found;
  for (int round = 0; round < most_rounds; ++round) {
    const auto sensors = signals_of(recording, found.factor, threads);
    const double change = best_divisor(sensors, round == 0 ? largest : near, threads);
    if (round == 0 && std::abs(std::log(change)) < fitted_log_factor) return found;
    found.factor *= change;
    if (round > 0 && std::abs(std::log(change)) < settled) break;
  }
  const auto sensors = signals_of(recording, found.factor, threads);
  found.gain = gain_over(sensors, 1.0, found.factor, threads);
  found.over_no_rate = gain_over(sensors, 1.0, no_rate, threads);
  return found;
}

void mend_rate_factor(MendedLog& log, int threads) {
  const RateFactor found = find_rate_factor(log.log(), threads);
  if (std::abs(std::log(found.factor)) < fitted_log_factor || found.gain < min_rate_factor_gain ||
      found.over_no_rate < min_rate_factor_gain)
    return;
  log.scales.gyroscope = {found.factor, rate_factor_sd};
  for (InsSensor& sensor : log.edit().sensors) {
    transform(sensor.angular_velocity, 1.0 / found.factor, Mat3::Identity());
    flag_faults(sensor);
  }
}

}  // namespace

ForceScale common_force_scale(std::span<const double> given) {
  const Readings readings = summary_of(given);
  ForceScale scale;
  scale.factor = readings.mean / usual_gravity;
  const double own =
      std::max(least_reading_error, std::sqrt(readings.square_scatter / std::max(1.0, readings.n - 1.0)));
  scale.sd = std::hypot(usual_gravity_sd, own / std::sqrt(readings.n)) / usual_gravity;
  const FactorLikelihood factors = likelihood_of_factors(readings);
  scale.log_odds = factors.log_likelihood - log_likelihood_on_earth(readings, 1.0) + log_force_scale_odds;
  scale.possible = std::sqrt(factors.mean_square / (1.0 + std::exp(-scale.log_odds)));
  return scale;
}

void mend_common_scales(MendedLog& log, int threads) {
  mend_force_scale(log);
  mend_rate_factor(log, threads);
}

}  // namespace kinfer::identify
