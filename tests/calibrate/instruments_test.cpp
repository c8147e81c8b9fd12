// SPDX-License-Identifier: Apache-2.0
// Each instrument alone, and several together, recover the errors of a simulated robot.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/calibrate/conclusion/unobserved_lengths.hpp"
#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/calibrate/start/fixtures.hpp"
#include "kinfer/calibrate/validation/validation_errors.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/words/calibration/calibration.hpp"
#include "support/instruments.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using namespace test;

/// Errors of the size that the default tolerances expect, everywhere.
Chain true_robot(int seed = 1) {
  return with_random_errors(nominal_robot(), {}, Rng(seed));
}

Calibration calibrated(const Chain& nominal, const PoseSet& data, const Instrument& instrument) {
  const auto c = calibrate_robot({nominal, {}, instrument, data}, {.model = FixedModel{}}, Rng(1));
  EXPECT_TRUE(c.has_value()) << c.error().what;
  return *c;
}

TEST(Instruments, DrawWiresToUncertainAnchorsCalibrateTheRobotAndTheAnchors) {
  Chain nominal = nominal_robot();
  nominal.fixtures.anchors = {Vec3(1.8, -0.9, 0.1), Vec3(1.7, 1.1, 0.2), Vec3(0.2, 0.3, 2.4)};
  Chain truth = with_random_errors(nominal, {}, Rng(2));
  truth.fixtures.anchors[0] += Vec3(4e-3, -5e-3, 3e-3);
  truth.fixtures.anchors[2] += Vec3(-6e-3, 2e-3, 1e-3);
  PoseSet data = readings_of(measured(truth, paper2_poses(50, noise_free)));
  measure_distances(data, truth, 10e-6, Rng(3));
  const Calibration c = calibrated(nominal, data, {.sigma = 10e-6});
  EXPECT_EQ(c.usability, Usability::use) << words::verdict(c);
  EXPECT_EQ(c.measured, kind_of<DistanceMeasurement>);
  EXPECT_LT(c.after.position.holdout.mean, 35e-6);
  EXPECT_GT(c.before.position.holdout.mean, 5.0 * c.after.position.holdout.mean);
}

TEST(Instruments, BallsInSocketsMakeHeldOutSocketsConsistent) {
  const Chain truth = true_robot();
  const std::vector<Vec3> sockets{{0.9, 0.5, 0.4}, {0.8, -0.6, 0.6}, {1.1, 0.1, 0.9}, {0.7, 0.3, 1.2}};
  PoseSet all = readings_of(measured(truth, paper2_poses(120, noise_free)));
  touch(
      all, truth, [&](int row) { return truth.base.pose() * sockets[row % 4]; }, 10e-6, Rng(4));
  PoseSet data = all, unseen = all;
  data.sockets = {"a", "b", "c"}, unseen.sockets = {"d"};
  std::vector<int> seen_rows, other_rows;
  for (int row = 0; row < 120; ++row) {
    if (row % 4 < 3)
      data.contacts.push_back({row, row % 4}), seen_rows.push_back(row);
    else
      unseen.contacts.push_back({row, 0}), other_rows.push_back(row);
  }
  data = select(data, seen_rows), unseen = select(unseen, other_rows);
  Chain nominal = nominal_robot();
  nominal.fixtures.socket_distances = {};
  const Calibration c = calibrated(nominal, data, {.sigma = 10e-6});
  EXPECT_EQ(c.measured, kind_of<SocketContact>);
  EXPECT_EQ(c.usability, Usability::use_with_care) << words::verdict(c);
  EXPECT_EQ(c.unobserved_lengths->kind, UnobservedLength::size);
  const auto spread = [&](const Chain& chain) {
    const DataWithFixtures there = with_fixtures(chain, unseen).value();
    return mean(position_errors_of_fit(kind_of<SocketContact>, there.chain, {}, there.data));
  };
  EXPECT_LT(spread(c.estimate.chain), 0.1 * spread(nominal));
  EXPECT_LT(spread(c.estimate.chain), 60e-6);
}

/// By how much `chain` is larger than `truth` over the poses: 1e-3 is 1 mm per metre.
double size_error(const Chain& chain, const Chain& truth, const PoseSet& data) {
  const std::vector<Pose> a = evaluate_poses(chain, {}, data, Derivative::no).pose,
                          b = evaluate_poses(truth, {}, data, Derivative::no).pose;
  double larger = 0.0, smaller = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      larger += (a[i].position - a[k].position).squaredNorm();
      smaller += (b[i].position - b[k].position).squaredNorm();
    }
  return std::sqrt(larger / smaller) - 1.0;
}

TEST(Instruments, TheSizeThatSocketsLeaveOpenIsAsUncertainAsSaid) {
  const std::vector<Vec3> sockets{{0.9, 0.5, 0.4}, {0.8, -0.6, 0.6}, {1.1, 0.1, 0.9}};
  const Tolerances tolerances;
  double squares = 0.0, sd = 0.0;
  constexpr int robots = 24;
  for (int seed = 1; seed <= robots; ++seed) {
    const Chain truth = with_random_errors(nominal_robot(), tolerances, Rng(seed));
    PoseSet data = readings_of(measured(truth, paper2_poses(60, noise_free)));
    data.sockets = {"a", "b", "c"};
    touch(
        data, truth, [&](int row) { return truth.base.pose() * sockets[row % 3]; }, 10e-6, Rng(seed + 100));
    for (int row = 0; row < 60; ++row) data.contacts.push_back({row, row % 3});
    const DataWithFixtures placed = with_fixtures(nominal_robot(), data).value();
    const CalibrationTask task{placed.chain, tolerances, Instrument{.sigma = 10e-6}, placed.data};
    const Estimate estimate = fit_once(task, task.data, GeometricParameters{}, {}, {}).value();
    const UnobservedLengths unobserved = find_unobserved_lengths(task, estimate).value();
    EXPECT_EQ(unobserved.kind, UnobservedLength::size);
    squares += std::pow(size_error(estimate.chain, truth, data) / unobserved.relative_sd, 2) / robots;
    sd += unobserved.relative_sd / robots;
  }
  EXPECT_GT(squares, 0.4);
  EXPECT_LT(squares, 1.9);
  EXPECT_GT(sd, 1e-4) << "millimetres of tolerance over a robot of a metre";
}

TEST(Instruments, OrientationsAloneLeaveAllLengthsOpen) {
  Chain truth = true_robot();
  PoseSet data = readings_of(measured(truth, paper2_poses(50, noise_free)));
  const std::vector<Pose> poses = evaluate_poses(truth, {}, data, Derivative::no).pose;
  for (int row = 0; row < 50; ++row)
    data.orientations.push_back({.row = row, .orientation = Quat(poses[row].rotation)});
  const Calibration c = calibrated(nominal_robot(), data, {.sigma = 10e-6, .sigma_angle = 1e-5});
  EXPECT_EQ(c.unobserved_lengths->kind, UnobservedLength::all_lengths);
  EXPECT_EQ(c.usability, Usability::use_with_care) << words::verdict(c);
}

TEST(Instruments, AKnownDistanceBetweenSocketsGivesTheScale) {
  const Chain truth = true_robot(3);
  const std::vector<Vec3> sockets{{0.9, 0.5, 0.4}, {0.8, -0.6, 0.6}, {1.1, 0.1, 0.9}};
  PoseSet data = readings_of(measured(truth, paper2_poses(90, noise_free)));
  data.sockets = {"a", "b", "c"};
  touch(
      data, truth, [&](int row) { return truth.base.pose() * sockets[row % 3]; }, 10e-6, Rng(4));
  for (int row = 0; row < 90; ++row) data.contacts.push_back({row, row % 3});
  Chain nominal = nominal_robot();
  const auto apart = [](const Chain& chain) {
    const auto& s = chain.fixtures.sockets;
    return (s[0].xyz - s[1].xyz).norm();
  };
  const double distance = (sockets[0] - sockets[1]).norm();
  nominal.fixtures.sockets = {{"b", Vec3::Zero()}, {"a", Vec3::Zero()}};  // in another order than in the data
  nominal.fixtures.socket_distances = {{0, 1, distance, 5e-6}};
  const Calibration c = calibrated(nominal, data, {.sigma = 10e-6});
  EXPECT_NEAR(apart(c.estimate.chain), distance, 15e-6);
  EXPECT_FALSE(c.unobserved_lengths);
  EXPECT_LT(relative_size_sd(c.estimate, data), 20e-6);
}

TEST(Instruments, BallBarsPlanesAndTiltsTogetherWithFewTrackerPoints) {
  const Chain truth = true_robot(5);
  const Vec3 normal = Vec3(0.1, -0.2, 1.0).normalized();
  PoseSet data = readings_of(measured(truth, paper2_poses(120, noise_free)));
  PoseSet on_table = select(data, [] {
    std::vector<int> rows(40);
    for (int i = 0; i < 40; ++i) rows[i] = i;
    return rows;
  }());
  touch(
      on_table, truth,
      [&](int row) {
        const Vec3 over = truth.base.pose() * Vec3(0.6 + 0.01 * row, 0.5 - 0.03 * row, 0.5);
        return Vec3(over - (normal.dot(over) - 0.7) * normal);
      },
      10e-6, Rng(5));
  data.joints.leftCols(40) = on_table.joints;
  data.planes = {"table"};
  for (int row = 0; row < 40; ++row) data.plane_contacts.push_back({row, 0});
  PoseSet wanted = data;
  measure_pairs(wanted, truth, 10e-6, Rng(6));
  for (const PairDistance& pair : wanted.pairs)
    if (pair.row >= 40) data.pairs.push_back(pair);
  measure_tilts(data, truth, 1e-3, Rng(7));
  PoseSet seen = data;
  measure_points(seen, truth, tracker, Rng(8));
  for (int row = 0; row < 120; row += 6) data.points.push_back(seen.points[row]);
  Instrument instrument = tracker;
  instrument.sigma_tilt = 1e-3;
  const Calibration c = calibrated(nominal_robot(), data, instrument);
  EXPECT_EQ(c.usability, Usability::use) << words::verdict(c);
  EXPECT_NEAR(*c.estimate.chi2_per_n, 1.0, 0.35);
  EXPECT_LT(mean(point_errors(c.estimate.chain, measured(truth, paper2_poses(200, noise_free), 99))), 100e-6);
}

TEST(Instruments, ErrorsOfTiltsAreAngles) {
  constexpr double noise = 5e-3;  // [m/s²]
  const Chain truth = true_robot(4);
  PoseSet data = readings_of(measured(truth, paper2_poses(60, noise_free)));
  measure_tilts(data, truth, noise, Rng(7));
  Instrument instrument;
  instrument.sigma_tilt = noise;
  const Calibration c = calibrated(nominal_robot(), data, instrument);
  EXPECT_EQ(c.measured, kind_of<TiltMeasurement>);
  const double expected = noise / truth.gravity.norm() * std::sqrt(0.5 * std::numbers::pi);  // of two axes
  EXPECT_EQ(c.after.orientation.holdout.n, 60);
  EXPECT_GT(c.after.orientation.holdout.mean, 0.9 * expected);
  EXPECT_LT(c.after.orientation.holdout.mean, 1.6 * expected);
  EXPECT_GT(c.before.orientation.holdout.mean, 2.0 * c.after.orientation.holdout.mean);
  EXPECT_EQ(words::verdict(c).find("Use with care: on poses that were not fitted the tilt is 0.0"), 0u)
      << words::verdict(c);
}

TEST(Instruments, TargetsWithoutTheToolPointDetermineTheToolsRotation) {
  Chain nominal = nominal_robot();
  nominal.targets = {{"s1", Vec3(0.1, 0, 0)}, {"s2", Vec3(0, 0.1, 0.02)}, {"s3", Vec3(-0.08, -0.05, 0.05)}};
  Chain truth = with_random_errors(nominal, {}, Rng(6));
  truth.tool.rotation = rot_z(0.4) * truth.tool.rotation;
  PoseSet data = readings_of(measured(truth, paper2_poses(40, noise_free)));
  data.targets = {"s1", "s2", "s3"};
  const std::vector<Pose> poses = true_poses(truth, data);
  Rng rng(9);
  for (int row = 0; row < 40; ++row)
    for (int t = 0; t < 3; ++t)
      data.points.push_back({row, t, poses[row] * truth.targets[t].xyz + noise(rng, 15e-6), {}});
  const Calibration c = calibrated(nominal, data, {.sigma = 15e-6});
  EXPECT_EQ(c.usability, Usability::use) << words::verdict(c);
  EXPECT_LT(c.after.position.holdout.mean, 45e-6);
}

TEST(Instruments, ACamerasStandardDeviationsWeightItsPoses) {
  const Chain truth = true_robot(7);
  PoseSimulation simulation = paper2_poses(60, {.sigma = 20e-6, .sigma_angle = 1e-4});
  simulation.measured = Measured::poses;
  PoseSet data = measured(truth, simulation);
  Rng rng(10);
  for (int row = 0; row < 60; ++row) {  // every second pose is inaccurate and has a matching sd
    const double sd = row % 2 ? 1e-3 : 20e-6;
    data.points[row].sd = Vec3::Constant(sd);
    data.orientations[row].sd = Vec3::Constant(row % 2 ? 5e-3 : 1e-4);
    if (row % 2 == 0) continue;
    data.points[row].position += noise(rng, 1e-3);
    data.orientations[row].orientation = quat_exp(noise(rng, 5e-3)) * data.orientations[row].orientation;
  }
  const Calibration c = calibrated(nominal_robot(), data, {.sigma = 20e-6, .sigma_angle = 1e-4});
  EXPECT_TRUE(c.estimate.outliers.empty());
  EXPECT_NEAR(*c.estimate.chi2_per_n, 1.0, 0.3);
  EXPECT_LT(mean(point_errors(c.estimate.chain, measured(truth, paper2_poses(200, noise_free), 99))), 60e-6);
}

/// Of the rows that the report draws.
double largest_drawn_error(const Calibration& c) {
  double largest = 0.0;
  for (const PlotRow& row : c.plot_data.rows) largest = std::max(largest, row.error_after->norm());
  return largest;
}

TEST(Instruments, EachSetupHasABaseAndToolOfItsOwn) {
  Chain truth = true_robot(8);
  truth.mountings = {{.name = "second",
                      .base = Frame::from_pose(Pose::from_xyz_rpy({3, 1, 0.5}, {0.1, 0.0, 2.0})),
                      .tool = Frame::from_pose(Pose::from_xyz_rpy({-0.05, 0.1, 0.2}, {0, 0, 0}))}};
  PoseSet data = readings_of(measured(truth, paper2_poses(60, noise_free)));
  data.setups = {"first", "second"};
  for (int row = 0; row < 60; ++row) data.setup.push_back(row % 2), data.mounting.push_back(row % 2 - 1);
  measure_points(data, truth, tracker, Rng(11));
  data.mounting.clear();
  const Calibration c = calibrated(nominal_robot(), data, tracker);
  EXPECT_EQ(c.usability, Usability::use) << words::verdict(c);
  EXPECT_LT(c.after.position.holdout.mean, 60e-6);
  ASSERT_EQ(c.estimate.chain.mountings.size(), 1u);
  EXPECT_EQ(c.estimate.chain.setup, "first");
  EXPECT_LT((c.estimate.chain.mountings[0].tool.xyz - truth.mountings[0].tool.xyz).norm(), 1e-3);
  EXPECT_LT(largest_drawn_error(c), 0.2e-3);
}

TEST(Instruments, BothArmsOfATreeAreCalibratedByRowsThatNameTheTip) {
  Chain nominal = er20(0.125);
  nominal.tip = 3;  // a torso of two axes; arm one is joints 3 and 4, arm two joints 5 to 7
  nominal.joints[4].parent = 1;
  nominal.joints.push_back(mdh_joint(0.3, 90, 0.2, -150, 150, 5));
  nominal.joints[6].name = "J7";
  nominal.tool.xyz = Vec3(0.05, 0.02, 0.3);
  nominal.mountings = {{.name = "J7", .base = {}, .tool = Frame{.xyz = Vec3(0.1, 0.03, 0.1)}, .tip = 6}};
  Chain truth = with_random_errors(nominal, {}, Rng(12));
  PoseSimulation anywhere{.poses = 120, .instrument = noise_free};
  PoseSet data = readings_of(simulate_pose_set(truth, anywhere, Rng(1)).value());
  data.tips = {"J7"};
  for (int row = 0; row < 120; ++row) data.tip.push_back(row % 2 - 1), data.mounting.push_back(row % 2 - 1);
  measure_points(data, truth, tracker, Rng(12));
  data.mounting.clear();
  const Calibration c = calibrated(nominal, data, tracker);
  EXPECT_EQ(c.usability, Usability::use) << words::verdict(c);
  EXPECT_LT(c.after.position.holdout.mean, 45e-6);
  EXPECT_GT(c.before.position.holdout.mean, 10.0 * c.after.position.holdout.mean);
  EXPECT_LT(largest_drawn_error(c), 0.2e-3);
}

/// No row is of the robot file's own arm, and the base that both arms stand on is not where the file says.
TEST(Instruments, TheBaseIsFoundByRowsThatAllNameTheOtherArm) {
  Chain nominal = er20(0.125);
  nominal.tip = 3;
  nominal.joints[4].parent = 1;
  nominal.tool.xyz = Vec3(0.05, 0.02, 0.3);
  nominal.joints[5].name = "J6";
  nominal.mountings = {{.name = "J6", .base = {}, .tool = Frame{.xyz = Vec3(0.1, 0.03, 0.1)}, .tip = 5}};
  Chain truth = with_random_errors(nominal, {}, Rng(12));
  truth.base = Frame::from_pose(Pose::from_xyz_rpy({1.2, -2.5, 0.35}, {0.02, -0.03, 2.3}));
  PoseSet data = readings_of(simulate_pose_set(truth, {.poses = 80, .instrument = noise_free}, Rng(1)).value());
  data.tips = {"J6"};
  data.tip.assign(80, 0), data.mounting.assign(80, 0);
  measure_points(data, truth, tracker, Rng(12));
  data.mounting.clear();
  const Calibration c = calibrated(nominal, data, tracker);
  EXPECT_EQ(c.usability, Usability::use) << words::verdict(c);
  EXPECT_LT(c.after.position.holdout.mean, 45e-6);
  EXPECT_LT((c.estimate.chain.base.xyz - truth.base.xyz).norm(), 5e-3);
}

TEST(Instruments, AnAnchorThatTheRobotFileLacksIsAnError) {
  PoseSet data = readings_of(measured(true_robot(), paper2_poses(10, noise_free)));
  data.distances.push_back({0, 1, 1.0});
  const auto c = calibrate_robot({nominal_robot(), {}, tracker, data}, {}, Rng(1));
  ASSERT_FALSE(c.has_value());
  EXPECT_NE(c.error().what.find("anchor 2, but the robot file lists 0"), std::string::npos) << c.error().what;
}

}  // namespace
}  // namespace kinfer
