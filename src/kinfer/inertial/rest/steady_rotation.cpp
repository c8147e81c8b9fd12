// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/rest/steady_rotation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include "kinfer/base/square.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

// Chosen on simulated excavators with industrial sensors whose carriage slews by 0.02 to 0.05 rad/s, steadily, to and
// fro, with and without a rest before.
constexpr std::size_t rate_count = 241;
constexpr double largest_rate = 0.3, rate_sd = 0.1;  // [rad/s] of a slew
constexpr double prior = 0.1;                        // of a rest to be a steady rotation
constexpr double freedom = 6.0;                      // of the biases' density
constexpr double typical_bias = 3.5e-3;              // [rad/s] that of industrial sensors, in place of two sensors
constexpr double known_bias_sd = 1.5e-3;             // [rad/s] of a sensor that rested once: it warms up
constexpr double part_length = 2.0;                  // [s] slews begin and turn back within what seems one rest
constexpr double doubtful_rates = 3.0;               // [biases] below which no rest is doubted

using Rests = std::vector<std::vector<RestPeriod>>;

double log_bias_density(double deviation, double sd) {
  return -std::log(sd) - 0.5 * (freedom + 1.0) * std::log1p(square(deviation / sd) / freedom);
}

Vec3 up(const RestPeriod& rest) {
  return rest.acceleration.normalized();
}

/// Biases of a recording: size of each component, from those across the vertical.
double bias_size(const Rests& rests) {
  double sum = 4.0 * square(typical_bias), count = 4.0;
  for (const auto& of_sensor : rests) {
    double squares = 0.0, seconds = 0.0;
    for (const RestPeriod& rest : of_sensor) {
      squares += rest.seconds() * up(rest).cross(rest.angular_velocity).squaredNorm();
      seconds += rest.seconds();
    }
    if (seconds > 0.0) sum += squares / seconds, count += 2.0;
  }
  return std::sqrt(sum / count);
}

/// What is known of a sensor's bias.
struct KnownBias {
  Vec3 mean = Vec3::Zero();
  double sd = 0.0;
};

/// Rate about the vertical beyond the bias.
struct VerticalRate {
  double value = 0.0, bias_sd = 0.0;
};

struct Weighed {
  double log_odds = 0.0;  // of a rotation
  double rate = 0.0;      // [rad/s] of it
};

class Weighing {
 public:
  Weighing(const Rests& rests, std::vector<KnownBias> biases) : rests_(rests), biases_(std::move(biases)) {}

  Weighed weigh(std::size_t sensor, const RestPeriod& rest) const {
    const VerticalRate own = vertical_rate(sensor, rest);
    const std::vector<VerticalRate> others = meanwhile(sensor, rest);
    std::array<double, rate_count> rotates{}, others_rotate{};
    double sum = 0.0, mean = 0.0;
    for (std::size_t k = 0; k < rate_count; ++k) {
      others_rotate[k] =
          std::log(step()) - 0.5 * square(rate(k) / rate_sd) - std::log(rate_sd * std::sqrt(2.0 * std::numbers::pi));
      for (const VerticalRate& other : others) others_rotate[k] += log_either(other, rate(k));
      rotates[k] = others_rotate[k] + log_bias_density(own.value - rate(k), own.bias_sd);
    }
    const double log_rotates = log_sum(rotates);
    for (std::size_t k = 0; k < rate_count; ++k) {
      const double weight = std::exp(rotates[k] - log_rotates);
      sum += weight, mean += weight * rate(k);
    }
    double all_rest = 0.0;
    for (const VerticalRate& other : others) all_rest += log_bias_density(other.value, other.bias_sd);
    const std::array<double, 2> rests{std::log(1.0 - prior) + all_rest, std::log(prior) + log_sum(others_rotate)};
    return {std::log(prior) + log_rotates - log_bias_density(own.value, own.bias_sd) - log_sum(rests), mean / sum};
  }

 private:
  static double step() { return 2.0 * largest_rate / (rate_count - 1); }
  static double rate(std::size_t k) { return -largest_rate + step() * static_cast<double>(k); }

  static double log_either(const VerticalRate& v, double r) {
    const std::array<double, 2> both{log_bias_density(v.value, v.bias_sd), log_bias_density(v.value - r, v.bias_sd)};
    return log_sum(both) - std::log(2.0);
  }

  VerticalRate vertical_rate(std::size_t sensor, const RestPeriod& rest) const {
    return {up(rest).dot(rest.angular_velocity - biases_[sensor].mean), biases_[sensor].sd};
  }

  /// Of each other sensor the rest that overlaps with this one by more than half of it.
  std::vector<VerticalRate> meanwhile(std::size_t sensor, const RestPeriod& rest) const {
    std::vector<VerticalRate> found;
    for (std::size_t s = 0; s < rests_.size(); ++s)
      for (const RestPeriod& other : rests_[s])
        if (s != sensor && std::min(other.end, rest.end) - std::max(other.begin, rest.begin) > 0.5 * rest.seconds()) {
          found.push_back(vertical_rate(s, other));
          break;
        }
    return found;
  }

  const Rests& rests_;
  std::vector<KnownBias> biases_;
};

/// The bias of the rest of each sensor that is most certainly none of a rotation.
std::vector<KnownBias> biases_of(const Rests& rests, double size) {
  std::vector<KnownBias> unknown(rests.size(), {Vec3::Zero(), size}), known = unknown;
  const Weighing weighing(rests, unknown);
  for (std::size_t s = 0; s < rests.size(); ++s) {
    double least = 0.0;
    for (const RestPeriod& rest : rests[s]) {
      const double odds = weighing.weigh(s, rest).log_odds;
      if (odds >= least) continue;
      least = odds;
      known[s] = {rest.angular_velocity, known_bias_sd};
    }
  }
  return known;
}

bool is_doubtful(const Rests& rests, double size) {
  return std::ranges::any_of(rests, [&](const auto& of_sensor) {
    return std::ranges::any_of(of_sensor, [&](const RestPeriod& rest) {
      return std::abs(up(rest).dot(rest.angular_velocity)) > doubtful_rates * size;
    });
  });
}

/// The rates of rotations are taken out.
Rests without_rotations(const Rests& rests, const std::vector<KnownBias>& biases) {
  Rests result = rests;
  const Weighing weighing(rests, biases);
  for (std::size_t s = 0; s < rests.size(); ++s)
    for (std::size_t i = 0; i < rests[s].size(); ++i) {
      const Weighed weighed = weighing.weigh(s, rests[s][i]);
      if (weighed.log_odds <= 0.0) continue;
      result[s][i].rotation = weighed.rate * up(rests[s][i]);
      result[s][i].angular_velocity -= result[s][i].rotation;
    }
  return result;
}

}  // namespace

std::vector<std::vector<RestPeriod>> rest_periods_of(const InsRecording& recording) {
  Rests rests, parts;
  for (const InsSensor& sensor : recording.sensors) rests.push_back(rest_periods(sensor, recording.time(sensor)));
  const double size = bias_size(rests);
  if (!is_doubtful(rests, size)) return rests;
  for (std::size_t s = 0; s < rests.size(); ++s) {
    parts.emplace_back();
    for (const RestPeriod& rest : rests[s])
      std::ranges::copy(in_parts(rest, part_length, recording.sensors[s], recording.time(recording.sensors[s])),
                        std::back_inserter(parts.back()));
  }
  const Rests rotating = without_rotations(parts, biases_of(parts, size));
  return std::ranges::any_of(rotating, [](const auto& of_sensor) { return steady_rate_limit(of_sensor).has_value(); })
             ? rotating
             : rests;
}

std::optional<double> steady_rate_limit(std::span<const RestPeriod> rests) {
  std::optional<double> limit;
  for (const RestPeriod& rest : rests) {
    const double rate = 0.5 * rest.rotation.cwiseAbs().maxCoeff();
    if (rate > 0.0) limit = std::min(limit.value_or(rate), rate);
  }
  return limit;
}

}  // namespace kinfer
