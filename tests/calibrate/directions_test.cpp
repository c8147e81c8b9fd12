// SPDX-License-Identifier: Apache-2.0
// Directions from stations of unknown pose (theodolites, cameras) calibrate a robot.
#include <gtest/gtest.h>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/calibrate/start/fixtures.hpp"
#include "kinfer/calibrate/start/initial_frames.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"
#include "kinfer/words/calibration/calibration.hpp"
#include "support/differences.hpp"
#include "support/instruments.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using namespace test;

constexpr double sigma = 1e-5;  // [rad] two arc seconds

std::vector<NamedFrame> two_stations() {
  return {{"west", Frame::from_pose(Pose::from_xyz_rpy({2.6, -1.8, 0.9}, {0.02, -0.01, 2.4}))},
          {"south", Frame::from_pose(Pose::from_xyz_rpy({-0.4, 3.0, 1.6}, {1.1, 0.4, -0.7}))}};
}

/// Each pose seen from each station, one row a station.
PoseSet seen_from_stations(const Chain& truth, int poses, double sd, int seed = 1) {
  std::vector<int> twice;
  for (int row = 0; row < 2 * poses; ++row) twice.push_back(row / 2);
  PoseSet set = select(readings_of(measured(truth, paper2_poses(poses, noise_free), seed)), twice);
  const std::vector<Pose> at = true_poses(truth, set);
  Rng rng(17);
  for (int row = 0; row < set.rows(); ++row) {
    const Pose station = truth.fixtures.stations[row % 2].frame.pose();
    const Vec3 sight = (station.inverse() * at[row].position).normalized();
    set.directions.push_back({row, row % 2, (sight + noise(rng, sd)).normalized()});
  }
  for (const NamedFrame& station : truth.fixtures.stations) set.stations.push_back(station.name);
  return set;
}

Chain robot_with_stations() {
  Chain truth = with_random_errors(nominal_robot(), {}, Rng(3));
  truth.fixtures.stations = two_stations();
  return truth;
}

TEST(Directions, TheJacobianEqualsDifferences) {
  Chain chain = robot_with_stations();
  chain.fixtures.stations[0].frame.small_rotation = Vec3(0.1, -0.2, 0.3);
  PoseSet data = seen_from_stations(chain, 6, 1e-3);
  data.directions[0].direction = exp_so3(Vec3(1.0, -2.0, 0.5)) * data.directions[0].direction;  // far off
  ParameterSet set = all_parameters(chain, {});
  const ParameterSet stations = setup_parameters(chain, {});
  ASSERT_EQ(stations.parameters.size(), 12U);
  EXPECT_EQ(stations.parameters[3].name, "station_west_rx");
  set.parameters.insert(set.parameters.end(), stations.parameters.begin(), stations.parameters.end());
  for (Parameter& parameter : set.parameters) parameter.free = field_of(parameter.at) != Field::compliance;
  const Weights weights = weights_of(data, Instrument{.sigma_direction = 1e-3});
  const Residuals problem = pose_residuals(chain, set, data, weights);
  const auto [jacobian, expected] = testing::jacobians(problem, pack(set, chain));
  for (Eigen::Index k = 0; k < jacobian.cols(); ++k)
    EXPECT_LT((jacobian.col(k) - expected.col(k)).norm(), 1e-6 * (10.0 + expected.col(k).norm()))
        << set.free()[static_cast<std::size_t>(k)]->name;
}

TEST(Directions, TheResidualIsTheAngleBetweenMeasuredAndPredicted) {
  const Chain chain = robot_with_stations();
  PoseSet data = seen_from_stations(chain, 3, 0.0);
  for (const double angle : {1e-6, 0.5e-3, 2e-3, 0.4, 2.5}) {
    const Vec3 axis = any_perpendicular(data.directions[0].direction);
    PoseSet turned = data;
    turned.directions[0].direction = exp_so3(angle * axis) * data.directions[0].direction;
    EXPECT_NEAR(residual_norms(kind_of<DirectionMeasurement>, chain, turned)[0], angle, 1e-12);
  }
}

TEST(Directions, ResectionFindsTheStationsOfAKnownRobotDespiteAGrossError) {
  const Chain truth = robot_with_stations();
  Chain start = truth;
  for (NamedFrame& station : start.fixtures.stations) station.frame = {};
  PoseSet data = seen_from_stations(truth, 30, 0.0);
  data.directions[4].direction = exp_so3(Vec3(0.02, 0.01, 0.0)) * data.directions[4].direction;
  const Chain found = with_initial_fixtures(start, data);
  for (std::size_t i = 0; i < 2; ++i) {
    const Pose expected = truth.fixtures.stations[i].frame.pose(), pose = found.fixtures.stations[i].frame.pose();
    EXPECT_LT((pose.position - expected.position).norm(), 1e-4);
    EXPECT_LT((pose.rotation - expected.rotation).norm(), 1e-4);
  }
}

TEST(Directions, AStationThatSeesTooFewPosesIsAnError) {
  const PoseSet data = select(seen_from_stations(robot_with_stations(), 10, 0.0), {0, 2, 4, 6, 1});
  const auto result = with_fixtures(nominal_robot(), data);
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().what, "station \"west\" sees 4 poses; at least 6 are needed to find where it stands");
}

Calibration calibrated_with(const PoseSet& data, const Instrument& instrument) {
  const auto c = calibrate_robot({nominal_robot(), {}, instrument, data}, {.model = FixedModel{}}, Rng(1));
  EXPECT_TRUE(c.has_value()) << c.error().what;
  return *c;
}

/// By a tracker that is as accurate as the stations at their distance from the robot.
Calibration calibrated_by_points(const Chain& truth) {
  constexpr double range = 2.5;  // [m]
  return calibrated_with(measured(truth, paper2_poses(60, {.sigma = sigma * range})), {.sigma = sigma * range});
}

TEST(Directions, TwoStationsCalibrateARobotAsWellAsPointsOfEqualAngularAccuracy) {
  const Chain truth = robot_with_stations();
  const PoseSet data = seen_from_stations(truth, 60, sigma);
  const Calibration c = calibrated_with(data, {.sigma = 1e-5, .sigma_direction = sigma});
  EXPECT_EQ(c.usability, Usability::use_with_care) << words::verdict(c);
  EXPECT_EQ(c.unobserved_lengths->kind, UnobservedLength::size) << "directions alone have no scale";
  EXPECT_EQ(c.measured, kind_of<DirectionMeasurement>);
  EXPECT_NEAR(*c.estimate.chi2_per_n, 1.0, 0.3);
  const Calibration by_points = calibrated_by_points(truth);
  EXPECT_LT(c.after.position.holdout.mean, 1.3 * by_points.after.position.holdout.mean);
  EXPECT_GT(c.before.position.holdout.mean, 5.0 * c.after.position.holdout.mean);
}

TEST(Directions, WithAFewBarLengthsForScaleTheToolIsAsNearTheTruthAsWithPoints) {
  const Chain truth = robot_with_stations();
  PoseSet data = seen_from_stations(truth, 60, sigma);
  const std::vector<Pose> at = true_poses(truth, data);
  Rng rng(6);
  for (int row = 0; row + 2 < data.rows(); row += 4)  // rows 2k and 2k + 1 are the same pose
    data.pairs.push_back({row, row + 2, (at[row].position - at[row + 2].position).norm() + 10e-6 * rng.normal()});
  const Calibration c = calibrated_with(data, {.sigma = 1e-5, .sigma_direction = sigma});
  const PoseSet fresh = measured(truth, paper2_poses(100, noise_free), 99);
  const auto error_of = [&](const Chain& chain) {
    return mean(point_errors(with_estimated_frames(chain, fresh).value(), fresh));
  };
  const double error = error_of(c.estimate.chain);
  EXPECT_LT(error, 2.0 * error_of(calibrated_by_points(truth).estimate.chain));
  EXPECT_LT(error, 0.2 * error_of(nominal_robot()));
}

TEST(Directions, HorizontalAnglesCountClockwiseAndVerticalOnesFromTheZenith) {
  const std::string header = "q1,q2,q3,q4,q5,q6,station,hz[deg],v[deg]\n";
  const auto set = parse_pose_set(header + "0,0,0,0,0,0,a,0,90\n0,0,0,0,0,0,a,90,90\n0,0,0,0,0,0,b,45,60\n",
                                  "poses.csv", nominal_robot(), {}, RequiredContent::measurements);
  ASSERT_TRUE(set.has_value()) << set.error().what;
  ASSERT_EQ(set->directions.size(), 3U);
  EXPECT_LT((set->directions[0].direction - Vec3::UnitX()).norm(), 1e-15);
  EXPECT_LT((set->directions[1].direction + Vec3::UnitY()).norm(), 1e-15);
  const double half = std::sqrt(0.75 / 2.0);
  EXPECT_LT((set->directions[2].direction - Vec3(half, -half, 0.5)).norm(), 1e-15);
  EXPECT_EQ(set->stations, (std::vector<std::string>{"a", "b"}));
}

TEST(Directions, RaysAreReadAsTheyWereWritten) {
  const Chain truth = robot_with_stations();
  const PoseSet data = seen_from_stations(truth, 4, sigma);
  const auto back = parse_pose_set(format_pose_set_csv(data, truth, FileUnits::mm_deg), "poses.csv", truth, {},
                                   RequiredContent::measurements);
  ASSERT_TRUE(back.has_value()) << back.error().what;
  ASSERT_EQ(back->directions.size(), data.directions.size());
  for (std::size_t i = 0; i < data.directions.size(); ++i) {
    EXPECT_EQ(back->directions[i].station, data.directions[i].station);
    EXPECT_LT((back->directions[i].direction - data.directions[i].direction).norm(), 1e-12);
  }
}

TEST(Directions, ADirectionWithoutAStationIsAnError) {
  const auto set = parse_pose_set("q1,q2,q3,q4,q5,q6,ray_x,ray_y,ray_z\n0,0,0,0,0,0,0.1,0.2,1\n", "poses.csv",
                                  nominal_robot(), {}, RequiredContent::measurements);
  ASSERT_FALSE(set.has_value());
  EXPECT_EQ(set.error().what, "poses.csv:2: column station: the name of the station is missing");
}

TEST(Directions, TheRobotFileKeepsStationsAndTheirAccuracy) {
  RobotModel robot{.chain = robot_with_stations(), .instrument = Instrument{.sigma = 1e-5, .sigma_direction = sigma}};
  const auto back = parse_robot_toml(format_robot_toml(robot, {{"station_west_x", 1e-4}}), "robot.toml");
  ASSERT_TRUE(back.has_value()) << back.error().what;
  EXPECT_NEAR(*back->instrument->sigma_direction, sigma, 1e-15);
  ASSERT_EQ(back->chain.fixtures.stations.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const NamedFrame &expected = robot.chain.fixtures.stations[i], &station = back->chain.fixtures.stations[i];
    EXPECT_EQ(station.name, expected.name);
    EXPECT_LT((station.frame.xyz - expected.frame.xyz).norm(), 1e-12);
    EXPECT_LT((station.frame.pose().rotation - expected.frame.pose().rotation).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace kinfer
