// Held-out figures count the same rows for every model: those whose measurement is not wrong.
#include "kinfer/calibrate/wrong_rows.hpp"

#include <gtest/gtest.h>

#include "support/instruments.hpp"

namespace kinfer {
namespace {

using namespace test;

/// 80 poses of a robot with gears that geometry cannot describe; rows 5, 20 and 60 lie 3 mm off.
PoseSet with_three_wrong_rows() {
  Chain truth = with_random_errors(nominal_robot(), {}, Rng(4));
  truth.joints[1].harmonics = {{1.0, 1.5e-4, 0.0}, {2.0, 1e-4, 1.5e-4}};
  PoseSet data = readings_of(measured(truth, paper2_poses(80, noise_free)));
  measure_points(data, truth, tracker, Rng(5));
  for (const int row : {5, 20, 60}) data.points[row].position += Vec3(3e-3, 0, 0);
  return data;
}

Calibration of_half(const PoseSet& data, const ModelChoice& model, int seed) {
  return calibrate({nominal_robot(), {}, tracker, data}, {.holdout = HeldOutFraction{0.5}, .model = model}, Rng(seed))
      .value();
}

TEST(WrongRows, that_are_held_out_are_listed_and_left_out_for_every_model_alike) {
  const PoseSet data = with_three_wrong_rows();
  for (const int seed : {1, 2, 3}) {
    const Calibration plain = of_half(data, NamedModel{}, seed), chosen = of_half(data, AutoModel{}, seed);
    for (const int row : chosen.wrong_rows)
      EXPECT_TRUE(std::find(plain.wrong_rows.begin(), plain.wrong_rows.end(), row) != plain.wrong_rows.end()) << row;
    EXPECT_LT(chosen.after.position.holdout.max, plain.after.position.holdout.max);
    const auto& held_out = chosen.after.position;
    EXPECT_EQ(held_out.holdout.n + static_cast<int>(chosen.wrong_rows.size()), held_out.holdout_all_rows.n);
    EXPECT_EQ(held_out.holdout_all_rows.n, 40);
    if (!chosen.wrong_rows.empty()) {
      EXPECT_GT(held_out.holdout_all_rows.max, 2.5e-3);
    }
    EXPECT_LT(held_out.holdout.max, 1e-3);
    const auto listed = [&](int row) {
      const auto& list = chosen.estimate.outliers;
      return std::any_of(list.begin(), list.end(), [&](const Outlier& outlier) { return outlier.row == row; });
    };
    EXPECT_TRUE(listed(5) && listed(20) && listed(60));
    for (const int row : chosen.wrong_rows) EXPECT_TRUE(row == 5 || row == 20 || row == 60) << row;
  }
}

TEST(WrongRows, the_verdict_names_them_and_what_the_worst_would_be) {
  const Calibration c = of_half(with_three_wrong_rows(), NamedModel{}, 1);
  ASSERT_FALSE(c.wrong_rows.empty());
  EXPECT_NE(c.verdict.find(std::to_string(c.wrong_rows.front())), std::string::npos) << c.verdict;
  EXPECT_NE(c.verdict.find("at worst with"), std::string::npos) << c.verdict;
}

TEST(WrongRows, rows_held_out_that_are_all_wrong_are_judged_all_the_same) {
  const Chain truth = with_random_errors(nominal_robot(), {}, Rng(1));
  PoseSet data = measured(truth, paper2_poses(60, tracker));
  data.set.assign(60, SetLabel::train);
  for (int row = 50; row < 60; ++row) {
    data.set[row] = SetLabel::holdout;
    data.points[row].position += Vec3(0, 5e-3, 0);
  }
  const Calibration c = calibrate({nominal_robot(), {}, tracker, data}, {}, Rng(1)).value();
  EXPECT_TRUE(c.wrong_rows.empty());
  EXPECT_EQ(c.after.position.holdout.n, 10);
  EXPECT_GT(c.after.position.holdout.mean, 4e-3);
  EXPECT_FALSE(c.use);
}

TEST(WrongRows, a_model_that_throws_a_row_out_of_place_is_not_excused) {
  const Chain truth = with_random_errors(nominal_robot(), {}, Rng(1));
  const PoseSet data = measured(truth, paper2_poses(40, tracker));
  Estimate geometry, rich;
  geometry.chain = rich.chain = truth;
  rich.chain.joints[1].harmonics = {{1.0, 1e-3, 0.0}};
  rich.outliers = {{7, 9, "far off", 90.0}};
  EXPECT_TRUE(wrong_beside_both(geometry, rich, data).empty());
  geometry.chain = rich.chain;
  EXPECT_EQ(wrong_beside_both(geometry, rich, data).size(), 1u);
}

}  // namespace
}  // namespace kinfer
