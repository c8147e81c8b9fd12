// SPDX-License-Identifier: Apache-2.0
#include "kinfer/deploy/verify.hpp"

#include <gtest/gtest.h>

#include "kinfer/deploy/predict.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/words/calibration/checks.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace deploy;
namespace {

using namespace test;

/// The paper's robot at an unknown place in a tracker's world, its target off the axis.
Chain on_a_stand(Chain chain) {
  chain.base = Frame::from_pose(Pose::from_xyz_rpy({1.2, -2.5, 0.35}, {0.02, -0.03, 2.3}));
  chain.tool.xyz = Vec3(0.03, 0.02, 0.1);
  return chain;
}

TEST(Verify, DistinguishesAMovedTrackerFromAChangedRobot) {
  const Chain truth = on_a_stand(with_table3_errors(er20(0.125)));
  const PoseSet today = measured(truth, paper2_poses(30, tracker), 5);
  EXPECT_EQ(verify(truth, {}, tracker, today)->result, VerificationResult::valid);

  Chain moved = truth;
  moved.base.xyz.x() += 0.01;
  const Verification after_move = verify(moved, {}, tracker, today).value();
  EXPECT_EQ(after_move.result, VerificationResult::frames_moved);
  EXPECT_NE(words::verdict(after_move).find("was moved"), std::string::npos);

  Chain bent = truth;
  std::get<MdhLink>(bent.joints[3].link).alpha += 0.2 * degree;
  const Verification after_knock = verify(bent, {}, tracker, today).value();
  EXPECT_EQ(after_knock.result, VerificationResult::robot_changed);
  EXPECT_NE(words::verdict(after_knock).find("Calibrate again"), std::string::npos);
}

/// What a calibration does not know is no excuse for what it says.
TEST(Verify, AChainThatItsCalibrationDoesNotKnowIsNotValid) {
  const Chain truth = on_a_stand(with_table3_errors(er20(0.125)));
  const PoseSet today = measured(truth, paper2_poses(30, tracker), 5);
  Chain bent = truth;
  std::get<MdhLink>(bent.joints[3].link).alpha += 12.0 * degree;
  const PredictionModel of_a_metre{.model_error = MatrixXd::Identity(6, 6),
                                   .rows = MatrixXd::Zero(6, 1),
                                   .spread = VectorXd::Ones(6),
                                   .noise = tracker.sigma};
  EXPECT_EQ(verify(truth, {}, tracker, today, of_a_metre)->result, VerificationResult::valid);
  EXPECT_EQ(verify(bent, {}, tracker, today, of_a_metre)->result, VerificationResult::robot_changed);
}

TEST(Verify, PointsMayStateTheirOwnDeviation) {
  const Chain truth = on_a_stand(with_table3_errors(er20(0.125)));
  PoseSet rough = measured(truth, paper2_poses(30, tracker), 5);
  Rng rng(2);
  for (PointMeasurement& point : rough.points) {
    const double x = rng.normal(), y = rng.normal(), z = rng.normal();
    point.position += 5e-3 * Vec3(x, y, z);
  }
  EXPECT_NE(verify(truth, {}, tracker, rough)->result, VerificationResult::valid);
  for (PointMeasurement& point : rough.points) point.sd = Vec3::Constant(5e-3);
  EXPECT_EQ(verify(truth, {}, tracker, rough)->result, VerificationResult::valid);
}

/// A refit of nine unknowns to three or four points leaves less than the noise, whatever happened.
TEST(Verify, FewPointsDoNotTellAMovedTrackerFromAChangedRobot) {
  const Chain truth = on_a_stand(with_table3_errors(er20(0.125)));
  Chain bent = truth;
  std::get<MdhLink>(bent.joints[3].link).alpha += 0.2 * degree;
  for (const int poses : {3, 4, 5}) {
    for (int seed = 1; seed <= 10; ++seed) {
      const PoseSet few = measured(truth, paper2_poses(poses, tracker), seed);
      EXPECT_EQ(verify(truth, {}, tracker, few)->result, VerificationResult::valid);
      const Verification changed = verify(bent, {}, tracker, few).value();
      EXPECT_EQ(changed.redundancy, 3 * poses - 9);
      EXPECT_NE(changed.result, VerificationResult::frames_moved) << poses << " poses, seed " << seed;
      if (poses == 3) EXPECT_EQ(changed.result, VerificationResult::moved_or_changed);
      const auto without_noise = verify(truth, {}, std::nullopt, few);
      if (poses < 5)
        EXPECT_NE(without_noise.error().what.find("measured numbers are too few"), std::string::npos);
      else
        EXPECT_EQ(without_noise->result, VerificationResult::valid) << seed;
    }
  }
  const PoseSet three = measured(truth, paper2_poses(3, tracker), 5);
  EXPECT_NE(words::verdict(verify(bent, {}, tracker, three).value()).find("too few to tell"), std::string::npos);
}

TEST(Verify, WithoutAnInstrumentOnlyAMovedFrameIsFound) {
  const Chain truth = on_a_stand(with_table3_errors(er20(0.125)));
  const PoseSet today = measured(truth, paper2_poses(30, tracker), 5);
  Chain moved = truth;
  moved.base.xyz.x() += 0.01;
  EXPECT_EQ(verify(truth, {}, std::nullopt, today)->result, VerificationResult::valid);
  EXPECT_EQ(verify(moved, {}, std::nullopt, today)->result, VerificationResult::frames_moved);
  const std::string unsure = words::verdict(verify(truth, {}, std::nullopt, today).value());
  EXPECT_NE(unsure.find("Whether the robot has changed cannot be told"), std::string::npos) << unsure;
}

TEST(Verify, AnInstrumentThatIsNotStatedIsTakenToBeAsInTheCalibration) {
  const Chain truth = on_a_stand(with_table3_errors(er20(0.125)));
  const PoseSet today = measured(truth, paper2_poses(30, tracker), 5);
  Chain bent = truth;
  std::get<MdhLink>(bent.joints[3].link).alpha += 0.2 * degree;
  const PredictionModel known{.rows = MatrixXd::Zero(6, 1), .spread = VectorXd::Ones(6), .noise = tracker.sigma};
  EXPECT_EQ(verify(truth, {}, std::nullopt, today, known)->result, VerificationResult::valid);
  EXPECT_EQ(verify(bent, {}, std::nullopt, today, known)->result, VerificationResult::robot_changed);
  EXPECT_NE(verify(bent, {}, std::nullopt, today)->result, VerificationResult::robot_changed) << "missed without it";
}

/// A chain whose gear corrections of joint 2 hold near its zero position only, and end there by `beyond`.
struct FadingChain {
  Chain near, far;
  PredictionModel prediction;
};
FadingChain fading_chain() {
  FadingChain model;
  model.far = on_a_stand(with_table3_errors(er20(0.125)));
  model.near = model.far;
  model.near.joints[1].harmonics = {{1.0, 3e-4, 5e-4}};
  model.prediction = {.parameters = {"sin1q2", "cos1q2"},
                      .root = MatrixXd::Zero(2, 2),
                      .rows = MatrixXd::Zero(6, 1),
                      .spread = VectorXd::Constant(6, 1e-3),
                      .beyond = Eigen::Vector2d(-3e-4, -5e-4)};
  return model;
}

TEST(Verify, CorrectionsThatFadeAreNoErrorOfTheRobot) {
  const auto [near, far, prediction] = fading_chain();
  const PoseSet today = measured(far, paper2_poses(30, tracker), 5);
  EXPECT_EQ(verify(near, {}, tracker, today)->result, VerificationResult::robot_changed);
  const Verification faded = verify(near, {}, tracker, today, prediction).value();
  EXPECT_EQ(faded.result, VerificationResult::valid);
  Chain moved = near;
  moved.base = Frame::from_pose(Pose::from_xyz_rpy({0.2, 0.5, 0.35}, {0.02, -0.03, -1.0}));
  const Verification placed = verify(moved, {}, tracker, today, prediction).value();
  EXPECT_EQ(placed.result, VerificationResult::frames_moved);
  EXPECT_NEAR(placed.frames_refitted.rms, faded.frames_refitted.rms, 1e-6);
}

TEST(Verify, APoseThatIsMeasuredAgainTellsNoMore) {
  const Chain truth = on_a_stand(with_table3_errors(er20(0.125)));
  const PoseSet today = measured(truth, paper2_poses(30, tracker), 5);
  EXPECT_EQ(verify(truth, {}, tracker, select(today, {0, 1, 2, 3, 4, 0, 1, 2, 3, 4}))->redundancy,
            verify(truth, {}, tracker, select(today, {0, 1, 2, 3, 4}))->redundancy);
  EXPECT_FALSE(verify(truth, {}, tracker, select(today, std::vector<int>(30, 7))));
}

/// Each set-up has a base and a tool of its own, and its points tell of them whatever poses the other one has.
TEST(Verify, APoseThatIsMeasuredInAnotherSetUpTellsOfThatOne) {
  Chain truth = on_a_stand(with_table3_errors(er20(0.125)));
  truth.setup = "first";
  truth.mountings = {{.name = "second",
                      .base = Frame::from_pose(Pose::from_xyz_rpy({-0.4, 1.5, 0.2}, {0.01, 0.02, -0.8})),
                      .tool = truth.tool}};
  const PoseSet once = measured(truth, paper2_poses(5, tracker), 5);
  PoseSet both = select(once, {0, 1, 2, 3, 4, 0, 1, 2, 3, 4});
  both.setups = {"first", "second"};
  for (int row = 0; row < 10; ++row) both.setup.push_back(row / 5);
  const Pose second_T_first = truth.mountings[0].base->pose() * truth.base.pose().inverse();
  for (PointMeasurement& point : both.points)
    if (point.row >= 5) point.position = second_T_first * point.position;
  const Verification v = verify(truth, {}, tracker, both).value();
  EXPECT_EQ(v.result, VerificationResult::valid);
  EXPECT_EQ(v.redundancy, 2 * verify(truth, {}, tracker, once)->redundancy);
}

TEST(Verify, NeedsMeasuredPositions) {
  PoseSet data = measured(er20(), paper2_poses(5, tracker));
  data.points.clear();
  EXPECT_EQ(verify(er20(), {}, tracker, data).error().what, "the data contain no measured positions to verify against");
}

TEST(Predict, RowsGetThePoseOfTheirSetup) {
  Chain chain = er20();
  PoseSet rows = measured(chain, paper2_poses(4, noise_free));
  const std::vector<Pose> poses = predict_poses(chain, rows).value();
  ASSERT_EQ(poses.size(), 4u);
  for (int row = 0; row < 4; ++row)
    EXPECT_LT((poses[row].position - forward(chain, rows.joints.col(row)).position).norm(), 1e-12);
}

}  // namespace
}  // namespace kinfer
