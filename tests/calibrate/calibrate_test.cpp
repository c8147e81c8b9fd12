// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/calibrate.hpp"

#include <gtest/gtest.h>

#include "kinfer/calibrate/diagnosis/diagnose.hpp"
#include "kinfer/calibrate/start/initial_frames.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/estimate/poses/pose_uncertainty.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/words/calibration/calibration.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using namespace test;

/// The paper's robot at an unknown place in a tracker's world, its target off the axis.
Chain placed(Chain chain) {
  chain.base = Frame::from_pose(Pose::from_xyz_rpy({1.2, -2.5, 0.35}, {0.02, -0.03, 2.3}));
  chain.tool.xyz = Vec3(0.03, 0.02, 0.1);
  return chain;
}

double mean_error_on_unseen_poses(const Chain& found, const Chain& truth) {
  return mean(point_errors(found, measured(truth, paper2_poses(300, noise_free), 4321)));
}

TEST(InitialFrames, BaseAndToolNeedNoInitialValues) {
  const Chain truth = placed(er20(0.125));
  const PoseSet data = measured(truth, paper2_poses(30, noise_free));
  Chain ignorant = truth;
  ignorant.base = Frame{};
  ignorant.tool = Frame{};
  const Chain found = with_estimated_frames(ignorant, data).value();
  EXPECT_LT((found.base.xyz - truth.base.xyz).norm(), 1e-6);
  EXPECT_LT(angle_between(found.base.pose().rotation, truth.base.pose().rotation), 1e-6);
  EXPECT_LT((found.tool.xyz - truth.tool.xyz).norm(), 1e-6);
}

TEST(InitialFrames, OrientationsAlsoGiveTheToolsRotation) {
  Chain truth = placed(er20(0.125));
  truth.tool = Frame::from_pose(Pose::from_xyz_rpy({0.1, -0.2, 0.3}, {1.0, -0.7, 2.5}));
  PoseSimulation simulation = paper2_poses(30, noise_free);
  simulation.measured = Measured::poses;
  Chain ignorant = truth;
  ignorant.base = Frame{};
  ignorant.tool = Frame{};
  const Chain found = with_estimated_frames(ignorant, measured(truth, simulation)).value();
  EXPECT_LT(angle_between(found.tool.pose().rotation, truth.tool.pose().rotation), 1e-6);
  EXPECT_LT((found.tool.xyz - truth.tool.xyz).norm(), 1e-6);
  EXPECT_LT((found.base.xyz - truth.base.xyz).norm(), 1e-6);
}

TEST(Calibrate, TrackerNoiseLeavesLessThan25Micrometres) {
  const Chain truth = placed(with_table3_errors(er20(0.125)));
  Chain nominal = er20(0.125);
  nominal.tool.xyz = truth.tool.xyz;
  const PoseSet data = measured(truth, paper2_poses(50, tracker));
  const Calibration c = calibrate_robot({nominal, {}, tracker, data}, {}, Rng(1)).value();
  EXPECT_LT(mean_error_on_unseen_poses(c.estimate.chain, truth), 25e-6);
  EXPECT_EQ(c.usability, Usability::use) << words::verdict(c);
  EXPECT_EQ(c.after.position.holdout.n, 50);
  EXPECT_LT(c.after.position.holdout.mean, 0.1 * c.before.position.holdout.mean);
}

TEST(Calibrate, FullPosesAreFittedInPositionAndOrientation) {
  const Chain truth = placed(with_table3_errors(er20(0.125)));
  PoseSimulation simulation = paper2_poses(50, {.sigma = 10e-6, .sigma_angle = 20e-6, .ppm = 5});
  simulation.measured = Measured::poses;
  const PoseSet data = measured(truth, simulation);
  const Calibration c = calibrate_robot({er20(0.125), {}, simulation.instrument, data}, {}, Rng(1)).value();
  EXPECT_LT(c.after.orientation.holdout.mean, 80e-6);
  EXPECT_LT(mean_error_on_unseen_poses(c.estimate.chain, truth), 25e-6);
}

TEST(Calibrate, TheInitialBaseDoesNotMatter) {
  const Chain truth = placed(with_table3_errors(er20(0.125)));
  const PoseSet data = measured(truth, paper2_poses(50, tracker));
  Chain near = er20(0.125), far = er20(0.125);
  near.base = truth.base;
  far.base = Frame::from_pose(Pose::from_xyz_rpy({-50, 20, 7}, {2, 1, -3}));
  const Calibration a = calibrate_robot({near, {}, tracker, data}, {}, Rng(1)).value();
  const Calibration b = calibrate_robot({far, {}, tracker, data}, {}, Rng(1)).value();
  EXPECT_NEAR(a.after.position.holdout.mean, b.after.position.holdout.mean, 1e-9);
}

TEST(Calibrate, ANominalModelThatIsFarOffIsDetectedAndReported) {
  Chain truth = placed(er20(0.125));
  auto& link = std::get<MdhLink>(truth.joints[2].link);
  link.theta += 12.0 * degree;
  link.a += 0.08;
  std::get<MdhLink>(truth.joints[4].link).theta -= 15.0 * degree;
  const PoseSet data = measured(truth, paper2_poses(60, tracker));
  const Calibration c = calibrate_robot({er20(0.125), {}, tracker, data}, {}, Rng(1)).value();
  EXPECT_LT(mean_error_on_unseen_poses(c.estimate.chain, truth), 40e-6);
  ASSERT_EQ(c.notes.size(), 1u);
  EXPECT_EQ(c.notes[0].kind, CalibrationNoteKind::tolerances_scaled);
  EXPECT_GE(c.notes[0].values.number("factor"), 10.0);
}

TEST(Calibrate, JointsThatNeverMoveDoNoHarmAndAreReported) {
  const Chain truth = placed(with_table3_errors(er20(0.125)));
  Chain nominal = er20(0.125);
  nominal.tool.xyz = truth.tool.xyz;
  Chain held = truth;  // three of six joints do not move
  for (const int j : {2, 4, 5}) held.joints[j].lower = held.joints[j].upper = 0.3;
  PoseSet data = measured(held, paper2_poses(40, tracker));
  const Calibration c = calibrate_robot({nominal, {}, tracker, data}, {}, Rng(1)).value();
  EXPECT_LT(c.estimate.identifiability.rank, 20);
  EXPECT_FALSE(c.estimate.identifiability.undetermined.empty());
  // Where all joints move, the result is no worse than the nominal chain with estimated base and tool.
  const Chain frames = with_estimated_frames(nominal, data).value();
  EXPECT_LE(mean_error_on_unseen_poses(c.estimate.chain, truth), mean_error_on_unseen_poses(frames, truth));
}

TEST(Calibrate, SameResultFor12And7Threads) {
  const Chain truth = placed(with_table3_errors(er20(0.125)));
  const PoseSet data = measured(truth, paper2_poses(40, tracker));
  const CalibrationTask task{er20(0.125), {}, tracker, data};
  const Calibration one = calibrate_robot(task, {.threads = 1}, Rng(1)).value();
  for (const int threads : {2, 7}) {
    const Calibration other = calibrate_robot(task, {.threads = threads}, Rng(1)).value();
    EXPECT_EQ(other.after.position.holdout.mean, one.after.position.holdout.mean);
    EXPECT_EQ(other.estimate.covariance, one.estimate.covariance);
  }
}

TEST(Calibrate, ThePapers24ParametersNeedNoInitialBaseEither) {
  const Chain truth = placed(with_table3_errors(er20(0.125)));
  Chain nominal = er20(0.125);
  nominal.tool.xyz = truth.tool.xyz;
  const PoseSet data = measured(truth, paper2_poses(50, tracker));
  const Calibration c =
      calibrate_robot({nominal, {}, tracker, data}, {.parameters = PaperDhParameters{}}, Rng(1)).value();
  EXPECT_EQ(c.reason, CalibrationReason::beyond_noise) << "24 of the robot's numbers";
  EXPECT_EQ(c.usability, Usability::use_with_care) << words::verdict(c);
  EXPECT_LT(c.after.position.holdout.mean, 0.5 * c.before.position.holdout.mean);
  ASSERT_EQ(c.notes.size(), 1u);
  EXPECT_EQ(c.notes[0].kind, CalibrationNoteKind::frames_from_data);
}

TEST(Calibrate, RowsMarkedHoldoutAreNeverFitted) {
  const Chain truth = placed(with_table3_errors(er20(0.125)));
  PoseSet data = measured(truth, paper2_poses(60, tracker));
  data.set.assign(60, SplitLabel::train);
  for (int row = 40; row < 60; ++row) data.set[row] = SplitLabel::holdout;
  const CalibrationTask task{er20(0.125), {}, tracker, data};
  const Calibration c = calibrate_robot(task, {}, Rng(1)).value();
  EXPECT_EQ(c.after.position.train.n, 40);
  EXPECT_EQ(c.after.position.holdout.n, 20);
  CalibrationTask spoiled = task;
  for (PointMeasurement& point : spoiled.data.points)
    if (point.row >= 40) point.position += Vec3(1, 2, 3);
  const Calibration same = calibrate_robot(spoiled, {}, Rng(1)).value();
  EXPECT_EQ(pack(same.estimate.parameters, same.estimate.chain), pack(c.estimate.parameters, c.estimate.chain));
  EXPECT_EQ(same.usability, Usability::do_not_use);  // and the spoiled validation is seen
}

TEST(Calibrate, ErrorsAboveTheInstrumentsAccuracyAreAdvisedAgainst) {
  Chain truth = placed(with_table3_errors(er20(0.125)));
  truth.joints[1].compliance = 2e-6;  // sags under its arm, which the geometric model cannot describe
  truth.masses = {{2, Vec3(0.4, 0, 0), 120.0}, {4, Vec3(0, 0, 0.1), 60.0}};
  const PoseSet data = measured(truth, paper2_poses(100, tracker));
  const Calibration c = calibrate_robot({er20(0.125), {}, tracker, data}, {.model = FixedModel{}}, Rng(1)).value();
  EXPECT_EQ(c.usability, Usability::do_not_use);
  EXPECT_GT(*c.estimate.chi2_per_n, 10.0);
  EXPECT_EQ(c.reason, CalibrationReason::unmodelled_effects);
}

TEST(Calibrate, TooFewRowsAreAnErrorThatStatesHowManyAreNeeded) {
  const PoseSet data = measured(placed(er20()), paper2_poses(3, tracker));
  const auto c = calibrate_robot({er20(), {}, tracker, data}, {}, Rng(1));
  ASSERT_FALSE(c.has_value());
  EXPECT_NE(c.error().what.find("at least 4"), std::string::npos) << c.error().what;
}

TEST(Calibrate, AnUnknownParameterNameListsTheKnownOnes) {
  const PoseSet data = measured(placed(er20()), paper2_poses(20, tracker));
  const auto c = calibrate_robot({er20(), {}, tracker, data}, {.parameters = NamedParameters{{"a2", "zeta9"}}}, Rng(1));
  ASSERT_FALSE(c.has_value());
  EXPECT_NE(c.error().what.find("\"zeta9\""), std::string::npos);
  EXPECT_NE(c.error().what.find("theta6"), std::string::npos);
}

TEST(Calibrate, RowsThatTheChosenModelExplainsAreNotNamedAsGrossErrors) {
  Chain truth = with_random_errors(test::nominal_robot(), {}, Rng(3));
  for (const std::size_t joint : {1U, 2U, 4U}) truth.joints[joint].torque_compliance = 2e-6;
  PoseSet data = test::measured(truth, {.poses = 120, .instrument = {}}, 3);
  Rng draws(4);
  data.torques = MatrixXd::NullaryExpr(6, 120, [&](auto, auto) { return 10.0 * draws.normal(); });
  const std::vector<int> loaded{7, 31, 55, 79, 103};
  data.torques(Eigen::all, loaded).array() += 200.0;
  const std::vector<Pose> tools = predicted_poses(truth, std::nullopt, data);
  for (PointMeasurement& point : data.points) {
    point.position = tools[static_cast<std::size_t>(point.row)].position;
    for (double& coordinate : point.position) coordinate += tracker.sigma * draws.normal();
  }
  data.points[20].position.x() += 0.003;
  const CalibrationTask task{test::nominal_robot(), {}, tracker, data};
  const auto named = [](const std::vector<Finding>& findings) {
    std::vector<int> rows;
    for (const Finding& f : findings)
      if (f.kind == FindingKind::gross_outliers) rows = f.rows;
    return rows;
  };
  ASSERT_GT(named(diagnose(task).findings).size(), 1U);  // geometry alone
  EXPECT_EQ(named(calibrate_robot(task, {}, Rng(1)).value().findings), (std::vector<int>{20}));
}

}  // namespace
}  // namespace kinfer
