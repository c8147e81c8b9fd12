// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/identification/traces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinfer {
namespace {

TEST(Traces, ASpikeOfOneSampleInAnHourStaysVisible) {
  std::vector<double> hour(720000, 0.0);
  hour[123457] = 40.0, hour[600001] = -30.0;
  const Binning bins = binning(hour.size(), 1000);
  const Envelope thin = envelope(hour, bins);
  ASSERT_EQ(thin.low.size(), 1000u);
  EXPECT_EQ(std::ranges::max(thin.high), 40.0);
  EXPECT_EQ(std::ranges::min(thin.low), -30.0);
  EXPECT_EQ(thin.high[123457 / 720], 40.0);
}

TEST(Traces, ShortSignalsKeepEverySample) {
  const std::vector<double> samples{3.0, 1.0, 2.0};
  const Binning bins = binning(3, 1000);
  EXPECT_EQ(bins.size, 1u);
  EXPECT_EQ(envelope(samples, bins).low, samples);
  EXPECT_EQ(envelope(samples, bins).high, samples);
}

TEST(Traces, ABinWithGapsUsesItsSamplesAndAnEmptyOneIsMarked) {
  constexpr double gap = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> samples{gap, 2.0, gap, gap, 5.0, 4.0};
  const Envelope thin = envelope(samples, binning(6, 3));
  EXPECT_EQ(thin.low[0], 2.0);
  EXPECT_TRUE(std::isnan(thin.low[1]));
  EXPECT_EQ(thin.low[2], 4.0);
  EXPECT_EQ(thin.high[2], 5.0);
}

TEST(Traces, TheLastBinMayBeShort) {
  const Binning bins = binning(10, 4);
  EXPECT_EQ(bins.size, 3u);
  EXPECT_EQ(bins.count(), 4u);
}

}  // namespace
}  // namespace kinfer
