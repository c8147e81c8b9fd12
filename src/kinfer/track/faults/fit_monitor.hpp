// SPDX-License-Identifier: Apache-2.0
// Whether each sensor agrees with all others through the chain: leave-one-out innovations, averaged over a short and a
// long time. The plain innovation is blind to a turned sensor, because the filter follows it.
//
// T_i = u_iᵀ [(S⁻¹)_ii]⁻¹ u_i, u = S⁻¹ν, has the number of the sensor's rows as its expectation.
#pragma once

#include "kinfer/track/filter/chain_filter.hpp"

namespace kinfer::track {

struct SensorFit {
  double quick = 1.0, slow = 1.0;  ///< T over its expectation, over short_mean and long_mean
  bool is_suspect = false;         ///< does not agree
  double since = 0.0;              ///< [s]
  double observed = 0.0;           ///< [s] that it was compared
  double strength = 0.0;           ///< the larger mean over its threshold
};

class FitMonitor {
 public:
  explicit FitMonitor(std::size_t sensors) : fits_(sensors), ordered_(sensors, 0.0) {}

  void add(const ChainFilter& filter, double time, double length);
  const SensorFit& operator[](std::size_t sensor) const { return fits_[sensor]; }

  /// The sensor that disagrees most among those in use; −1: none does.
  int worst(const ChainFilter& filter) const;
  /// A sensor that is not in use and agrees again; −1: none.
  int recovered(const ChainFilter& filter) const;
  void reset(std::size_t sensor) { fits_[sensor] = {}; }
  void reset();
  void set(std::size_t sensor, const SensorFit& fit) { fits_[sensor] = fit; }

 private:
  double median_of_others(const ChainFilter& filter, std::size_t sensor, double SensorFit::*mean) const;

  std::vector<SensorFit> fits_;
  mutable std::vector<double> ordered_;  // buffer of the median
};

}  // namespace kinfer::track
