// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/prediction/model_error.hpp"

#include <gtest/gtest.h>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/deploy/predict.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

/// An arm whose third gear harmonic [rad] is known to no term.
Chain true_arm(int seed, double unknown) {
  Chain truth = with_random_errors(test::nominal_robot(), {}, Rng(seed));
  for (Joint& joint : truth.joints) joint.harmonics = {{3.0, unknown, 0.0}};
  return truth;
}

PoseSet measured_poses(const Chain& truth, int poses, int seed) {
  return test::measured(truth, {.poses = poses, .instrument = test::tracker, .measured = Measured::poses}, seed);
}

Calibration calibrated_arm(const PoseSet& data) {
  return calibrate_robot({test::nominal_robot(), {}, test::tracker, data}, {}, Rng(1)).value();
}

/// Points of `rows` within the 95 % ellipsoids of prediction and instrument.
int points_inside(const Chain& chain, const PredictionModel& model, const PoseSet& rows) {
  const auto poses = deploy::predict_poses(chain, rows).value();
  const auto uncertainties = deploy::predict_uncertainties(chain, model, rows).value();
  const double limit = chi_squared_quantile(0.95, 3.0);
  int inside = 0;
  for (const PointMeasurement& point : rows.points) {
    const Vec3 error = point.position - poses[point.row].position;
    const Mat3 covariance =
        uncertainties[point.row].position + std::pow(position_sd(test::tracker, point.position), 2) * Mat3::Identity();
    inside += error.dot(Vec3(solve_spd(MatrixXd(covariance), VectorXd(error)).value())) <= limit;
  }
  return inside;
}

TEST(ModelError, NinetyFivePercentOfUnseenPointsLieInTheirEllipsoids) {
  constexpr int robots = 12, unseen = 200;
  int inside = 0;
  for (int seed = 1; seed <= robots; ++seed) {
    const Chain truth = true_arm(seed, seed % 2 ? 0.0 : 2e-4);
    const Calibration c = calibrated_arm(measured_poses(truth, 50 + 25 * (seed % 3), seed));
    ASSERT_TRUE(c.prediction);
    inside += points_inside(corrected_chain(c), *c.prediction, measured_poses(truth, unseen, 1000 + seed));
  }
  const double share = static_cast<double>(inside) / (robots * unseen);
  EXPECT_GT(share, 0.92);
  EXPECT_LT(share, 0.97);
}

TEST(ModelError, ExpectedErrorsAreThoseOfUnseenPosesAlsoWhereNoTermExplainsThem) {
  for (const double unknown : {0.0, 4e-4}) {
    const Chain truth = true_arm(3, unknown);
    const Calibration c = calibrated_arm(measured_poses(truth, 45, 3));
    const Chain chain = corrected_chain(c);
    const PoseSet unseen = measured_poses(truth, 300, 4);
    const auto uncertainties = deploy::predict_uncertainties(chain, *c.prediction, unseen).value();
    double squares = 0.0, expected = 0.0;
    for (const PointMeasurement& point : unseen.points) {
      expected +=
          uncertainties[point.row].position.trace() + 3.0 * std::pow(position_sd(test::tracker, point.position), 2);
      squares += (point.position - forward(chain, unseen.joints.col(point.row)).position).squaredNorm();
    }
    EXPECT_GT(std::sqrt(expected / squares), 0.7) << unknown;
    EXPECT_LT(std::sqrt(expected / squares), 1.5) << unknown;
  }
}

TEST(ModelError, GrowsOutsideTheMeasuredRegionAndItsRowsAreNamed) {
  const Chain truth = true_arm(5, 2e-4);
  PoseSet data = measured_poses(truth, 80, 5);
  std::vector<int> left;
  for (int row = 0; row < data.rows(); ++row)
    if (data.joints(0, row) < 0.0) left.push_back(row);
  const Calibration c = calibrated_arm(select(data, left));
  PoseSet rows;
  rows.joints = MatrixXd(6, 2);
  rows.joints.col(0) = data.joints.col(left.front());
  rows.joints.col(1) = rows.joints.col(0);
  rows.joints(0, 1) += 4.0;
  const auto variance = [&](int row) {
    return model_error_at(*c.prediction, rows.joints.col(row)).topLeftCorner(3, 3).trace();
  };
  EXPECT_GT(variance(1), variance(0));
  const auto outside = deploy::find_rows_outside(*c.prediction, rows);
  ASSERT_TRUE(outside);
  EXPECT_EQ(outside->kind, FindingKind::outside_region);
  EXPECT_EQ(outside->rows, std::vector<int>{1});
}

/// An arm with eccentric gears and yielding joints.
Chain arm_with_gears(int seed) {
  Chain truth = with_random_errors(test::nominal_robot(), {}, Rng(seed));
  for (Joint& joint : truth.joints) joint.harmonics = {{1.0, 2e-4, 0.0}, {2.0, 0.0, 1e-4}}, joint.compliance = 4e-6;
  truth.masses = {{1, Vec3(0.3, 0, 0.1), 25.0}, {2, Vec3(0.1, 0, 0.1), 15.0}};
  return truth;
}

TEST(ModelError, CorrectionsOfGearsFadeFarFromTheMeasuredRegion) {
  const Chain truth = arm_with_gears(5);
  const PoseSet data = measured_poses(truth, 200, 5);
  const Calibration c = calibrate_robot({[&] {
                                           Chain nominal = test::nominal_robot();
                                           nominal.masses = truth.masses;
                                           return nominal;
                                         }(),
                                         {},
                                         test::tracker,
                                         data},
                                        {}, Rng(1))
                            .value();
  ASSERT_TRUE(c.prediction);
  ASSERT_GT(c.prediction->beyond.size(), 0) << selected_model(c.model_selection);
  const Chain chain = corrected_chain(c), beyond = chain_with_corrections(chain, *c.prediction, 0.0);
  for (const Joint& joint : beyond.joints)
    for (const Harmonic& harmonic : joint.harmonics) EXPECT_LT(std::hypot(harmonic.sine, harmonic.cosine), 1e-12);
  bool yields = false;
  for (const Joint& joint : beyond.joints) yields |= joint.compliance > 1e-6;
  EXPECT_TRUE(yields) << "loads act everywhere";

  PoseSet rows;
  rows.joints = data.joints.leftCols(2);
  rows.joints.col(1).array() += 40.0;
  const auto poses = deploy::predict_poses(chain, rows, c.prediction).value();
  EXPECT_LT((poses[0].position - forward(chain, rows.joints.col(0)).position).norm(), 1e-9);
  EXPECT_LT((poses[1].position - forward(beyond, rows.joints.col(1)).position).norm(),
            0.01 * (forward(chain, rows.joints.col(1)).position - forward(beyond, rows.joints.col(1)).position).norm());

  RobotModel robot{.chain = chain};
  robot.prediction = c.prediction;
  const RobotModel again = parse_robot_toml(format_robot_toml(robot), "chain.toml").value();
  const auto read = deploy::predict_poses(again.chain, rows, again.prediction).value();
  for (int row = 0; row < 2; ++row) EXPECT_LT((read[row].position - poses[row].position).norm(), 1e-8);
}

TEST(ModelError, ChainTomlKeepsWhatPredictionsNeed) {
  const Chain truth = true_arm(7, 2e-4);
  const Calibration c = calibrated_arm(measured_poses(truth, 60, 7));
  RobotModel robot{.chain = corrected_chain(c)};
  robot.prediction = c.prediction;
  const RobotModel again = parse_robot_toml(format_robot_toml(robot), "chain.toml").value();
  ASSERT_TRUE(again.prediction);
  const PoseSet rows = measured_poses(truth, 20, 8);
  const auto before = deploy::predict_uncertainties(robot.chain, *robot.prediction, rows).value(),
             after = deploy::predict_uncertainties(again.chain, *again.prediction, rows).value();
  for (std::size_t row = 0; row < before.size(); ++row) {
    EXPECT_LT((after[row].position - before[row].position).norm(), 1e-4 * before[row].position.norm());
    EXPECT_LT((after[row].rotation - before[row].rotation).norm(), 1e-4 * before[row].rotation.norm());
  }
}

}  // namespace
}  // namespace kinfer
