// SPDX-License-Identifier: Apache-2.0
#include "kinfer/deploy/compensate.hpp"

#include <gtest/gtest.h>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
using namespace deploy;
namespace {

using namespace test;

/// Distances between the real robot's tool and the nominal targets.
std::vector<double> misses(const Chain& real, const Chain& nominal, const MatrixXd& wanted,
                           const std::vector<CompensatedJoints>& sent) {
  std::vector<double> list;
  for (std::size_t i = 0; i < sent.size(); ++i)
    list.push_back((forward(real, sent[i].q).position - forward(nominal, wanted.col(i)).position).norm());
  return list;
}

TEST(Compensate, AnExactlyKnownRobotReachesTheNominalTargets) {
  const Chain nominal = er20(), real = with_table3_errors(nominal);
  const MatrixXd q = measured(nominal, paper2_poses(50, noise_free)).joints;
  const auto sent = compensate_joints(real, nominal, q, 1);
  for (std::size_t i = 0; i < sent.size(); ++i) {
    if (sent[i].status != InverseStatus::reached) continue;
    EXPECT_LT(misses(real, nominal, q, sent)[i], 1e-8);
    EXPECT_LT(angle_between(forward(real, sent[i].q).rotation, forward(nominal, q.col(i)).rotation), 1e-8);
  }
  EXPECT_GT(std::count_if(sent.begin(), sent.end(),
                          [](const CompensatedJoints& c) { return c.status == InverseStatus::reached; }),
            45);
}

TEST(Compensate, TheRemainingErrorIsThatOfTheIdentifiedModel) {
  const Chain nominal = er20(), real = with_table3_errors(nominal);
  CalibrationTask task{nominal, {}, tracker, measured(real, paper2_poses(50, tracker)), {}, {}};
  const Chain found = calibrate_robot(task, {.parameters = PaperDhParameters{}}, Rng(1)).value().estimate.chain;
  const PoseSet wanted = measured(nominal, paper2_poses(100, noise_free), 77);
  const auto sent = compensate_joints(found, nominal, wanted.joints, 1);
  PoseSet visited = wanted;
  for (std::size_t i = 0; i < sent.size(); ++i) visited.joints.col(i) = sent[i].q;
  const double before = median(misses(real, nominal, wanted.joints, [&] {
    std::vector<CompensatedJoints> uncorrected(100);
    for (int i = 0; i < 100; ++i) uncorrected[i].q = wanted.joints.col(i);
    return uncorrected;
  }()));
  // The model's own error against the real robot at the compensated joint positions.
  for (PointMeasurement& point : visited.points) point.position = forward(real, visited.joints.col(point.row)).position;
  const double model_error = median(point_errors(found, visited));
  const double after = median(misses(real, nominal, wanted.joints, sent));
  EXPECT_GT(before, 0.5e-3);
  EXPECT_NEAR(after, model_error, 0.02 * model_error);
  EXPECT_LT(after, 0.05 * before);
}

TEST(Compensate, ATargetIsReachedByTheRealToolWithoutAStart) {
  const Chain nominal = er20(), real = with_table3_errors(nominal);
  const MatrixXd q = measured(nominal, paper2_poses(20, noise_free)).joints;
  std::vector<ToolTarget> targets;
  for (int i = 0; i < 20; ++i) {
    const Pose wanted = forward(nominal, q.col(i));
    targets.push_back({wanted.position, wanted.rotation});
  }
  const auto sent = compensate_targets(real, nominal, targets, {}, 1, 1);
  int reached = 0;
  for (int i = 0; i < 20; ++i) {
    if (sent[i].status != InverseStatus::reached) continue;
    ++reached;
    EXPECT_LT((forward(real, sent[i].q).position - targets[i].position).norm(), 1e-8);
  }
  EXPECT_GE(reached, 18);
}

/// The first joint of the real robot counts from 60 degrees elsewhere, so behind it some elbows are beyond its limit.
TEST(Compensate, AnotherPostureIsTakenWhereTheNominalOneIsBeyondALimit) {
  Chain nominal;
  nominal.joints = {mdh_joint(0, 0, 0.3, -170, 170, -1), mdh_joint(0.4, 0, 0, -140, 140, 0)};
  nominal.tool.xyz = Vec3(0.3, 0, 0);
  Chain real = nominal;
  std::get<MdhLink>(real.joints[0].link).theta -= 60.0 * degree;
  std::vector<ToolTarget> targets;
  for (int direction = -180; direction < 180; direction += 10)
    targets.push_back({Vec3(rot_z(direction * degree) * Vec3(0.6, 0, 0.3)), std::nullopt});
  for (const CompensatedJoints& row : compensate_targets(real, nominal, targets, {}, 1, 1))
    EXPECT_EQ(row.status, InverseStatus::reached);
}

TEST(Compensate, ATargetOutOfReachIsReported) {
  const Chain nominal = er20();
  const auto sent = compensate_targets(nominal, nominal, {{Vec3(9, 0, 0), std::nullopt}}, {}, 1, 1);
  EXPECT_NE(sent[0].status, InverseStatus::reached);
  EXPECT_GT(sent[0].residual, 5.0);
}

TEST(Compensate, AnInstrumentsWorldIsDistinguishedFromASmallBaseError) {
  const Chain nominal = er20();
  Chain near = nominal, far = nominal;
  near.base.xyz = Vec3(0.02, 0, 0);
  far.base.xyz = Vec3(2, 0, 0);
  EXPECT_EQ(select_compensation_frames(near, nominal, {}), CompensationFrames::as_given);
  EXPECT_EQ(select_compensation_frames(far, nominal, {}), CompensationFrames::robot);
  EXPECT_EQ(express_in_frames(far, nominal, CompensationFrames::robot).base.xyz, nominal.base.xyz);
}

/// A robot that yields to loads and grows when it is warm.
Chain yielding_robot() {
  Chain real = with_table3_errors(er20());
  real.joints[1].compliance = real.joints[2].compliance = 2e-6;
  real.joints[2].torque_compliance = 1e-6;
  real.expansion = 1.2e-5, real.reference_temperature = 20.0;
  return real;
}

PoseSet loaded_rows(const Chain& nominal) {
  PoseSet rows = measured(nominal, paper2_poses(30, noise_free));
  for (int row = 0; row < 30; ++row) {
    rows.payload.push_back(row % 2 * 20.0);
    rows.temperature.push_back(20.0 + row);
  }
  rows.torques = MatrixXd::Constant(6, 30, 50.0);
  return rows;
}

TEST(Compensate, TheToolIsPutInPlaceUnderTheLoadOfEachRow) {
  const Chain nominal = er20(), real = yielding_robot();
  const PoseSet rows = loaded_rows(nominal);
  const auto sent = compensate_joints(real, nominal, rows, 1),
             unloaded = compensate_joints(real, nominal, rows.joints, 1);
  std::vector<ToolTarget> targets;
  for (int row = 0; row < 30; ++row) targets.push_back({forward(nominal, rows.joints.col(row)).position, std::nullopt});
  const auto by_targets = compensate_targets(real, nominal, targets, rows.joints, 1, 1, std::nullopt, rows);
  int reached = 0;
  for (int row = 0; row < 30; ++row) {
    const Load load = load_at(real, rows, row);
    const Vec3 wanted = targets[row].position;
    if (sent[row].status != InverseStatus::reached || by_targets[row].status != InverseStatus::reached) continue;
    ++reached;
    EXPECT_LT((forward(real, sent[row].q, load).position - wanted).norm(), 1e-8) << row;
    EXPECT_LT((forward(real, by_targets[row].q, load).position - wanted).norm(), 1e-8) << row;
    if (row > 0) EXPECT_GT((forward(real, unloaded[row].q, load).position - wanted).norm(), 1e-5) << row;
  }
  EXPECT_GT(reached, 25);
}

TEST(Compensate, RowsOfAnotherSetUpAreRefused) {
  const Chain chain = er20();
  PoseSet rows = measured(chain, paper2_poses(4, noise_free));
  EXPECT_TRUE(expect_own_mounting(chain, rows));
  rows.setups = {"first", "second"};
  rows.setup = {0, 0, 0, 0};
  EXPECT_TRUE(expect_own_mounting(chain, rows));
  rows.setup = {0, 0, 1, 1};
  const auto refused = expect_own_mounting(chain, rows);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("\"second\", another set-up or arm"), std::string::npos) << refused.error().what;
}

/// A robot that hangs on a wall of the instrument's world yields to a weight that pulls along the wall.
TEST(Compensate, InTheRobotsFramesGravityStaysWhereTheRobotFeelsIt) {
  const Chain nominal = er20();
  Chain corrected = with_table3_errors(nominal);
  corrected.joints[1].compliance = corrected.joints[2].compliance = 2e-6;
  corrected.masses = {{.joint = 2, .com = Vec3(0.2, 0.0, 0.1), .mass = 80.0}};
  corrected.base = Frame::from_pose(Pose::from_xyz_rpy({1.2, -2.5, 0.35}, {90.0 * degree, 0.02, 2.3}));
  const Chain expressed = express_in_frames(corrected, nominal, CompensationFrames::robot);
  const Pose moved = nominal.base.pose() * corrected.base.pose().inverse();
  const MatrixXd q = measured(nominal, paper2_poses(10, noise_free)).joints;
  for (Eigen::Index i = 0; i < q.cols(); ++i) {
    const Pose found = forward(expressed, q.col(i)), expected = moved * forward(corrected, q.col(i));
    EXPECT_LT((found.position - expected.position).norm(), 1e-12) << i;
    EXPECT_LT(angle_between(found.rotation, expected.rotation), 1e-7) << i;
  }
}

TEST(Compensate, SameJointPositionsFor12And7Threads) {
  const Chain nominal = er20(), real = with_table3_errors(nominal);
  const std::vector<ToolTarget> targets(9, {Vec3(1.0, 0.3, 0.8), std::nullopt});
  const auto one = compensate_targets(real, nominal, targets, {}, 1, 1);
  for (const int threads : {2, 7}) {
    const auto other = compensate_targets(real, nominal, targets, {}, threads, 1);
    for (std::size_t i = 0; i < targets.size(); ++i) EXPECT_EQ(one[i].q, other[i].q);
  }
}

}  // namespace
}  // namespace kinfer
