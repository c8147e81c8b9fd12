// SPDX-License-Identifier: Apache-2.0
// Held-out figures use the same rows for every model: those without a gross measurement error.
#include "kinfer/calibrate/validation/gross_errors.hpp"

#include <gtest/gtest.h>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/words/calibration/calibration.hpp"
#include "support/instruments.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using namespace test;

/// 80 poses of a robot with gear harmonics that geometry cannot describe; rows 5, 20 and 60 are 3 mm off.
PoseSet with_three_wrong_rows() {
  Chain truth = with_random_errors(nominal_robot(), {}, Rng(4));
  truth.joints[1].harmonics = {{1.0, 1.5e-4, 0.0}, {2.0, 1e-4, 1.5e-4}};
  PoseSet data = readings_of(measured(truth, paper2_poses(80, noise_free)));
  measure_points(data, truth, tracker, Rng(5));
  for (const int row : {5, 20, 60}) data.points[row].position += Vec3(3e-3, 0, 0);
  return data;
}

Calibration of_half(const PoseSet& data, const ModelChoice& model, int seed) {
  return calibrate_robot({nominal_robot(), {}, tracker, data}, {.holdout = HeldOutFraction{0.5}, .model = model},
                         Rng(seed))
      .value();
}

TEST(GrossErrors, HeldOutOnesAreListedAndExcludedForEveryModelAlike) {
  const PoseSet data = with_three_wrong_rows();
  for (const int seed : {1, 2, 3}) {
    const Calibration plain = of_half(data, FixedModel{}, seed), chosen = of_half(data, AutomaticModel{}, seed);
    for (const int row : chosen.gross_error_rows)
      EXPECT_TRUE(std::find(plain.gross_error_rows.begin(), plain.gross_error_rows.end(), row) !=
                  plain.gross_error_rows.end())
          << row;
    EXPECT_LT(chosen.after.position.holdout.max, plain.after.position.holdout.max);
    const auto& held_out = chosen.after.position;
    EXPECT_EQ(held_out.holdout.n + static_cast<int>(chosen.gross_error_rows.size()), held_out.holdout_all_rows.n);
    EXPECT_EQ(held_out.holdout_all_rows.n, 40);
    if (!chosen.gross_error_rows.empty()) {
      EXPECT_GT(held_out.holdout_all_rows.max, 2.5e-3);
    }
    EXPECT_LT(held_out.holdout.max, 1e-3);
    const auto listed = [&](int row) {
      const auto& list = chosen.estimate.outliers;
      return std::any_of(list.begin(), list.end(), [&](const Outlier& outlier) { return outlier.row == row; });
    };
    EXPECT_TRUE(listed(5) && listed(20) && listed(60));
    for (const int row : chosen.gross_error_rows) EXPECT_TRUE(row == 5 || row == 20 || row == 60) << row;
  }
}

TEST(GrossErrors, TheVerdictNamesThemAndTheWorstErrorWithThem) {
  const Calibration c = of_half(with_three_wrong_rows(), FixedModel{}, 1);
  ASSERT_FALSE(c.gross_error_rows.empty());
  EXPECT_NE(words::verdict(c).find(std::to_string(c.gross_error_rows.front())), std::string::npos) << words::verdict(c);
  EXPECT_NE(words::verdict(c).find("at worst with"), std::string::npos) << words::verdict(c);
}

TEST(GrossErrors, HeldOutRowsThatAreAllWrongAreEvaluatedAllTheSame) {
  const Chain truth = with_random_errors(nominal_robot(), {}, Rng(1));
  PoseSet data = measured(truth, paper2_poses(60, tracker));
  data.set.assign(60, SplitLabel::train);
  for (int row = 50; row < 60; ++row) {
    data.set[row] = SplitLabel::holdout;
    data.points[row].position += Vec3(0, 5e-3, 0);
  }
  const Calibration c = calibrate_robot({nominal_robot(), {}, tracker, data}, {}, Rng(1)).value();
  EXPECT_TRUE(c.gross_error_rows.empty());
  EXPECT_EQ(c.after.position.holdout.n, 10);
  EXPECT_GT(c.after.position.holdout.mean, 4e-3);
  EXPECT_EQ(c.usability, Usability::do_not_use);
}

TEST(GrossErrors, ARowThatOnlyOneModelMissesIsNotExcluded) {
  const Chain truth = with_random_errors(nominal_robot(), {}, Rng(1));
  const PoseSet data = measured(truth, paper2_poses(40, tracker));
  Estimate geometry, rich;
  geometry.chain = rich.chain = truth;
  rich.chain.joints[1].harmonics = {{1.0, 1e-3, 0.0}};
  rich.outliers = {{.row = 7, .line = 9, .sigmas = 90.0}};
  EXPECT_TRUE(gross_errors_of_both_models(geometry, rich, data).empty());
  geometry.chain = rich.chain;
  EXPECT_EQ(gross_errors_of_both_models(geometry, rich, data).size(), 1u);
}

}  // namespace
}  // namespace kinfer
