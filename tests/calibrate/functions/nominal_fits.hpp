// SPDX-License-Identifier: Apache-2.0
// Fits of the nominal robot's geometry to readings, and their errors.
#pragma once

#include <gtest/gtest.h>

#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/estimate/poses/bundle.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "support/instruments.hpp"

namespace kinfer::test {

inline Estimate geometry_of(const PoseSet& data) {
  const Chain chain = nominal_robot();
  return fit_bundle(chain, calibrate::geometric_parameters(chain, data, {}), data, tracker);
}

/// [m] of the measured points.
inline double mean_error(const Chain& chain, const PoseSet& data) {
  return mean(point_errors(chain, data));
}

/// No free parameter lowers `cost(chain)` by more than 1 when it is moved a little.
template <class Cost>
void expect_least_cost(const Chain& chain, const ParameterSet& set, Cost cost) {
  const double least = cost(chain);
  for (const Parameter* p : set.free())
    for (const double by : {-1e-5, 1e-5}) {
      Chain other = chain;
      set_value_at(other, p->at, value_at(chain, p->at) + by);
      EXPECT_GT(cost(other), least - 1.0) << p->name;
    }
}

}  // namespace kinfer::test
