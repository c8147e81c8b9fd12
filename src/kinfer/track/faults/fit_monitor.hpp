// SPDX-License-Identifier: Apache-2.0
// Whether each sensor agrees with all others through the chain, and the sensors beyond each joint with those before it:
// leave-one-out innovations, averaged over a short and a long time. The plain innovation is blind to a turned sensor,
// because the filter follows it.
//
// T_i = u_iᵀ [(S⁻¹)_ii]⁻¹ u_i, u = S⁻¹ν, has the number of the sensor's rows as its expectation; T of a joint is that
// of JointChanges.
#pragma once

#include <functional>

#include "kinfer/track/faults/usual_peak.hpp"
#include "kinfer/track/filter/chain_filter.hpp"

namespace kinfer::track {

struct Agreement {
  double quick = 1.0, slow = 1.0;         ///< T over its expectation, over short_mean and long_mean
  bool is_suspect = false;                ///< does not agree
  double since = 0.0;                     ///< [s]
  double observed = 0.0;                  ///< [s] that it was compared
  double compared = 0.0;                  ///< [s] when it was compared last
  double strength = 0.0;                  ///< the larger mean over its threshold
  double explains = 1.0;                  ///< over short_mean, of the unlimited T
  bool was_named = false;                 ///< before
  UsualPeak usual{};                      ///< of the short mean
  std::optional<double> unusual_since{};  ///< [s] that it has been beyond that
};

/// As it starts when it is named, by others where it is not suspect itself: it fits again after agreeing for twice
/// long_mean or so.
Agreement as_named(Agreement agreement, double time);

/// What explains best that the chain does not fit: a sensor or a joint; −1: none.
struct Suspect {
  int sensor = -1, joint = -1;
  bool operator==(const Suspect&) const = default;
};

class FitMonitor {
 public:
  FitMonitor(std::size_t sensors, std::size_t joints)
      : sensors_(sensors), joints_(joints), ordered_(std::max(sensors, joints), 0.0) {}

  void add(const ChainFilter& filter, double time, double length);
  const Agreement& sensor(std::size_t index) const { return sensors_[index]; }
  const Agreement& joint(std::size_t index) const { return joints_[index]; }

  /// Among sensors in use and joints that are not doubted.
  Suspect worst(const ChainFilter& filter) const;
  /// A sensor that is not in use and may return, or a joint that is doubted, and agrees again.
  Suspect recovered(const ChainFilter& filter, const std::function<bool(std::size_t)>& may_return) const;
  /// It is taken in again. One that was named before may be named at once.
  void reset_sensor(std::size_t index);
  void reset_joint(std::size_t index);
  void reset();
  /// But for sensors that are out of use and joints that are doubted.
  void reset_trusted(const ChainFilter& filter);
  void set_sensor(std::size_t index, const Agreement& agreement) { sensors_[index] = agreement; }
  void set_joint(std::size_t index, const Agreement& agreement) { joints_[index] = agreement; }

 private:
  Suspect likeliest_of(const std::function<bool(const Agreement&)>& is_candidate, const ChainFilter& filter) const;
  double median_of_others(const ChainFilter& filter, std::size_t sensor, double Agreement::*mean) const;
  double median_of_other_joints(const ChainFilter& filter, std::size_t joint, double Agreement::*mean) const;

  std::vector<Agreement> sensors_, joints_;
  mutable std::vector<double> ordered_;  // buffer of the medians
};

}  // namespace kinfer::track
