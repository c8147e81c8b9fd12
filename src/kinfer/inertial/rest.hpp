// When a sensor stands still: its rate and specific force, freed of noise over a twentieth of a second, keep to their
// own mean of the last half second, and the rate is no more than a bias can be.
#pragma once

#include <span>
#include <vector>

#include "kinfer/inertial/low_pass.hpp"
#include "kinfer/measurement/ins_recording.hpp"

namespace kinfer {

struct RestOptions {
  double noise_time = 0.05;             ///< [s] noise is averaged away over this; longer sees smaller motions, later
  double mean_time = 0.5;               ///< [s] the mean that a still sensor keeps to
  double rate_threshold = 8.7e-3;       ///< [rad/s] (0.5 °/s) leaving the mean by more than this is motion
  double acceleration_threshold = 0.2;  ///< [m/s²] likewise
  double largest_bias = 0.052;          ///< [rad/s] (3 °/s) a steady rate above this is a turn, not a bias
  double shortest = 0.25;               ///< [s] stillness before it counts
};

/// Streams: one per sensor, copyable.
struct RestDetector {
  LowPass<Vec3> fast_rate{Vec3::Zero()}, slow_rate{Vec3::Zero()};
  LowPass<Vec3> fast_acceleration{Vec3::Zero()}, slow_acceleration{Vec3::Zero()};
  double still = 0.0;  ///< [s] stillness so far

  void add(const InsSample& sample, double dt, const RestOptions& options);
  bool at_rest(const RestOptions& options) const { return still >= options.shortest; }
};

/// A stretch of rows, first to last, in which a sensor stood still, and what it read there.
struct Rest {
  std::size_t first_row = 0, last_row = 0;
  double begin = 0.0, end = 0.0;     ///< [s]
  Vec3 rate = Vec3::Zero();          ///< [rad/s] mean: the gyro bias, if the base stands still
  Vec3 rate_sd = Vec3::Zero();       ///< [rad/s] of one row
  Vec3 acceleration = Vec3::Zero();  ///< [m/s²] mean
  Vec3 acceleration_sd = Vec3::Zero();
  double seconds() const { return end - begin; }
};

/// All rests of a sensor that last at least a second; the first and last 0.1 s of each are left out.
std::vector<Rest> rests(const InsSensor& sensor, std::span<const double> time, const RestOptions& options = {});

/// Gyro bias as the rests tell it: their mean weighted by length, and how far they spread beyond their own noise.
struct RestBias {
  Vec3 mean = Vec3::Zero();    ///< [rad/s]
  Vec3 spread = Vec3::Zero();  ///< [rad/s] weighted standard deviation over the rests; 0 for a single one
  double seconds = 0.0;        ///< of rest in all; 0: nothing is known
};
RestBias bias_at_rest(std::span<const Rest> rests);

}  // namespace kinfer
