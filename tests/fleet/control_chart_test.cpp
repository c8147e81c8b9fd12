// SPDX-License-Identifier: Apache-2.0
#include "kinfer/fleet/control_chart.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "kinfer/base/rng.hpp"
#include "kinfer/fleet/monitoring.hpp"
#include "kinfer/fleet/thresholds.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

std::vector<double> gaussian_series(Rng rng, std::size_t n, double mean, double sd) {
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i) values.push_back(mean + sd * rng.normal());
  return values;
}

TEST(ControlChart, InnovationsAreStandardGaussianWhateverMeanAndSpread) {
  std::vector<double> all;
  for (int series = 0; series < 2000; ++series) {
    const auto innovations = fleet::standardised_innovations(gaussian_series(Rng(7).stream(series), 12, 50.0, 1e-3));
    all.insert(all.end(), innovations.begin() + 2, innovations.end());
  }
  EXPECT_NEAR(mean(all), 0.0, 0.02);
  EXPECT_NEAR(standard_deviation(all), 1.0, 0.02);
  EXPECT_NEAR(quantile(all, 0.975), normal_quantile(0.975), 0.04);
  EXPECT_NEAR(quantile(all, 0.001), normal_quantile(0.001), 0.2);
}

TEST(ControlChart, LongHistoriesAreContinuedWithoutAStep) {
  std::vector<double> values(70);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = i % 2 == 0 ? 1.0 : -1.0;  // mean 0, sd about 1
  const auto innovations = fleet::standardised_innovations(values);
  for (std::size_t i = 40; i + 2 < values.size(); i += 2) EXPECT_NEAR(innovations[i], innovations[i + 2], 3e-3) << i;
}

TEST(ControlChart, TheFalseAlarmRateIsTheOneStated) {
  constexpr int series = 4000;
  constexpr std::size_t length = 2000;
  const double limit = fleet::limit_for_run_length(300.0);
  std::vector<double> runs;
  for (int k = 0; k < series; ++k) {
    const auto alarm = fleet::cusum_alarm(gaussian_series(Rng(3).stream(k), length, 0.0, 1.0), limit);
    runs.push_back(alarm ? static_cast<double>(alarm->noticed) + 1.0 : static_cast<double>(length));
  }
  // The few that are cut off would be longer by about one run length.
  EXPECT_NEAR(mean(runs), 300.0, 0.05 * 300.0);
  EXPECT_NEAR(fleet::average_run_length(limit), 300.0, 1e-6);
}

TEST(ControlChart, AShiftIsFoundWithItsBeginning) {
  int found = 0, near = 0;
  for (int k = 0; k < 200; ++k) {
    auto values = gaussian_series(Rng(11).stream(k), 60, 3.0, 0.1);
    for (std::size_t i = 30; i < values.size(); ++i) values[i] += 0.3;
    const auto alarm = fleet::cusum_alarm(fleet::standardised_innovations(values), fleet::limit_for_run_length(1000.0));
    if (!alarm) continue;
    ++found;
    const auto since = static_cast<double>(fleet::change_point(values, alarm->noticed));
    near += alarm->rises && std::abs(since - 30.0) <= 3.0 ? 1 : 0;
  }
  EXPECT_GE(found, 196);
  EXPECT_GE(near, 180);
}

/// `robots` with 30 dated checks each; the rms error of the first rises by `factor` from the twentieth on.
std::vector<FleetRow> dated_checks(Rng rng, int robots, double factor) {
  std::vector<FleetRow> rows;
  for (int robot = 0; robot < robots; ++robot)
    for (int day = 0; day < 30; ++day) {
      const double rms = 1e-4 * std::exp(0.1 * rng.stream(robot).stream(day).normal());
      rows.push_back({.key = fmt::format("r{}_{}", robot, day),
                      .verb = "verify",
                      .robot = fmt::format("r{}", robot),
                      .date = fmt::format("2026-03-{:02}", day + 1),
                      .summary = {.figures = {{"rms_m", robot == 0 && day >= 20 ? factor * rms : rms}}}});
    }
  return rows;
}

TEST(Monitoring, FindsTheRobotThatDriftsAndSinceWhen) {
  const ControlChartSummary chart = fleet::monitor(dated_checks(Rng(1), 40, 1.6));
  ASSERT_EQ(chart.alarms.size(), 1U);
  EXPECT_EQ(chart.alarms[0].robot, "r0");
  EXPECT_EQ(chart.alarms[0].since, "2026-03-21");
  EXPECT_TRUE(chart.alarms[0].rises);
}

TEST(Monitoring, AFleetWithoutChangeIsAlarmedAsRarelyAsStated) {
  int alarmed = 0;
  constexpr int fleets = 200;
  for (int k = 0; k < fleets; ++k)
    alarmed += fleet::monitor(dated_checks(Rng(100 + static_cast<std::uint64_t>(k)), 10, 1.0)).alarms.empty() ? 0 : 1;
  EXPECT_LE(alarmed, 20) << "10 are expected of 200 at " << fleet::thresholds::chart_risk;
}

}  // namespace
}  // namespace kinfer
