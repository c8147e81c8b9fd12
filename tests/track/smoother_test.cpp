// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/smooth/smoother.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "kinfer/track/smooth/pass_state.hpp"
#include "kinfer/track/smooth/reversed.hpp"
#include "kinfer/track/tracker.hpp"
#include "support/tracked_machine.hpp"

namespace kinfer::track {
namespace {

struct TrackedDrive {
  test::SimulatedDrive drive;
  TrackingModel model;
  std::vector<InsRow> rows{};
};

TrackedDrive tracked_drive(const test::DriveSetup& setup) {
  TrackedDrive made{.drive = test::simulated_drive(setup), .model = {}};
  made.model = test::tracking_model_of(made.drive.machine, *sensor_grade(setup.grade), setup.sampling_rate);
  for (std::size_t r = 0; r < made.drive.recording.loggers.front().time.size(); ++r)
    test::fill_row(made.drive.recording, r, made.rows.emplace_back());
  return made;
}

const TrackedDrive& excavator() {
  static const TrackedDrive made = tracked_drive({.duration = 40.0});
  return made;
}

/// Sums over the rows between two times: squared errors, their squares over variance.
struct Errors {
  VectorXd squares, nees;
  int rows = 0;

  double rms(int joint) const { return std::sqrt(squares[joint] / rows); }
};

struct Score {
  const TrackedDrive& truth;
  double begin = 0.0, end = 1e9;
  Errors errors{.squares = VectorXd::Zero(truth.model.positions()), .nees = VectorXd::Zero(truth.model.positions())};
  std::size_t row = 0;

  void add(const TrackState& state) {
    const std::size_t r = row++;
    if (!state.started || state.time < begin || state.time > end) return;
    ++errors.rows;
    for (int j = 1; j < truth.model.positions(); ++j) {  // the first counts from the start
      const double e = state.q[j] - truth.drive.q(j, static_cast<Eigen::Index>(r));
      errors.squares[j] += e * e;
      errors.nees[j] += e * e / (state.sd_q[j] * state.sd_q[j]);
    }
  }
};

Errors filtered(const TrackedDrive& truth, const std::vector<InsRow>& rows, double begin, double end) {
  Score score{truth, begin, end};
  Tracker tracker(truth.model);
  for (const InsRow& row : rows) tracker.add(row), score.add(tracker.state());
  return score.errors;
}

Errors smoothed(const TrackedDrive& truth, const std::vector<InsRow>& rows, double begin, double end) {
  Score score{truth, begin, end};
  smooth(truth.model, {}, rows, [&](const TrackState& state) { score.add(state); });
  EXPECT_EQ(score.row, rows.size()) << "a state per row";
  return score.errors;
}

TEST(Smoother, IsNotWorseThanTheFilterInAnyJointAndBetterInTheMean) {
  const TrackedDrive& given = excavator();
  const Errors before = filtered(given, given.rows, 1.0, 39.0), after = smoothed(given, given.rows, 1.0, 39.0);
  double gain = 0.0;
  for (int j = 1; j < 5; ++j) {
    EXPECT_LT(after.rms(j), 1.3 * before.rms(j)) << j;
    EXPECT_LT(after.nees[j] / after.rows, 2.0) << j;
    gain += std::log(before.rms(j) / after.rms(j)) / 4.0;
  }
  EXPECT_GT(gain, 0.0);
}

TEST(Smoother, BridgesALostSensorFromBothSides) {
  const TrackedDrive& given = excavator();
  double gain = 0.0;
  for (const int lost : {2, 3, 4}) {  // the joints on both sides of its segment are lost with it
    std::vector<InsRow> rows = given.rows;
    for (InsRow& row : rows)
      if (row.time > 15.0 && row.time < 30.0) row.sensors[static_cast<std::size_t>(lost)] = {.time = row.time};
    const Errors before = filtered(given, rows, 15.0, 30.0), after = smoothed(given, rows, 15.0, 30.0);
    for (const int joint : {lost - 1, lost}) {
      EXPECT_LT(after.nees[joint] / after.rows, 4.0) << joint;
      EXPECT_LT(after.rms(joint), 0.15 * std::numbers::pi / 180.0) << joint;  // 0.16 before rests bridged a lost sensor
      gain += std::log(before.rms(joint) / after.rms(joint)) / 6.0;
    }
  }
  EXPECT_GT(gain, 0.0);
}

TEST(Smoother, KnowsWhereTheMachineIsFromTheFirstRowOn) {
  const TrackedDrive& given = excavator();
  bool is_first = true;
  smooth(given.model, {}, given.rows, [&](const TrackState& state) {
    if (!is_first) return;
    is_first = false;
    EXPECT_TRUE(state.started);
    EXPECT_GT(state.sd_q[0], 0.02) << "the axis is vertical but for milliradians";
    EXPECT_LT(std::abs(state.q[0] - given.drive.q(0, 0)), 3.0 * state.sd_q[0]);
    for (int j = 1; j < 5; ++j) EXPECT_NEAR(state.q[j], given.drive.q(j, 0), 0.005) << j;
  });
}

TEST(Smoother, OfNoRowsIsNothing) {
  smooth(excavator().model, {}, {}, [](const TrackState&) { FAIL(); });
}

TEST(Reversed, TwiceIsTheSame) {
  const TrackingModel model = excavator().model, again = reversed(reversed(model));
  EXPECT_EQ(again.covariance, model.covariance);
  EXPECT_EQ(again.sensors[0].gyroscope_bias, model.sensors[0].gyroscope_bias);
  InsRow row = excavator().rows[100];
  const InsRow twice = reversed(reversed(row, 40.0), 40.0);
  EXPECT_DOUBLE_EQ(twice.time, row.time);
  EXPECT_EQ(twice.sensors[1].angular_velocity, row.sensors[1].angular_velocity);
  EXPECT_EQ(twice.sensors[1].acceleration, row.sensors[1].acceleration);
}

TEST(Blend, IsTheMeanByVarianceWhereNothingIsShared) {
  const Blend mean = blend({0.3, 0.0}, {0.4, 0.0});
  EXPECT_NEAR(mean.share, 0.09 / 0.25, 1e-12);
  EXPECT_NEAR(mean.sd, 0.3 * 0.4 / 0.5, 1e-12);
}

TEST(Blend, IsAsGoodAsTheBetterOneWhereAllIsShared) {
  EXPECT_NEAR(blend({0.3, 0.3}, {0.4, 0.4}).sd, 0.3, 1e-12);
  EXPECT_NEAR(blend({0.4, 0.4}, {0.3, 0.3}).sd, 0.3, 1e-12);
  EXPECT_NEAR(blend({0.3, 0.3}, {0.3, 0.3}).sd, 0.3, 1e-12);
}

TEST(Blend, HasTheLeastVarianceOfAllShares) {
  const SharedSd a{0.5, 0.3}, b{0.7, 0.45};
  const Blend best = blend(a, b);
  for (double w = 0.0; w <= 1.0; w += 0.01) {
    const double own = (1.0 - w) * (1.0 - w) * (0.25 - 0.09) + w * w * (0.49 - 0.2025),
                 shared = (1.0 - w) * 0.3 + w * 0.45;
    EXPECT_GE(std::sqrt(own + shared * shared), best.sd - 1e-12) << w;
  }
}

}  // namespace
}  // namespace kinfer::track
