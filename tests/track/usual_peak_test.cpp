// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/faults/usual_peak.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace kinfer::track {
namespace {

/// Every 20 ms from one time to another.
void add(UsualPeak& peak, double value, double from, double until) {
  for (double time = from; time < until; time += 0.02) peak.add(value, time);
}

TEST(UsualPeak, IsNotKnownAtOnce) {
  UsualPeak peak;
  add(peak, 3.0, 5.0, 14.0);
  EXPECT_FALSE(peak.value());
  add(peak, 3.0, 14.0, 16.0);
  EXPECT_NEAR(peak.value().value(), 3.0, 1e-12);
}

TEST(UsualPeak, LeavesOutTheLastSecondsAndForgetsWithinMinutes) {
  UsualPeak peak;
  add(peak, 1.0, 0.0, 20.0);
  add(peak, 7.0, 20.0, 21.9);
  EXPECT_NEAR(peak.value().value(), 1.0, 1e-12) << "what has just begun is not usual";
  add(peak, 1.0, 21.9, 27.0);
  EXPECT_NEAR(peak.value().value(), 7.0, 0.5);
  add(peak, 1.0, 27.0, 86.0);
  EXPECT_NEAR(peak.value().value(), 7.0 * std::exp(-1.0), 0.3);
}

}  // namespace
}  // namespace kinfer::track
