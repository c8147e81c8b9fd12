// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/start/initial_posture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinfer/geometry/random.hpp"
#include "kinfer/track/model/thresholds.hpp"
#include "kinfer/track/start/thresholds.hpp"

namespace kinfer::track {
namespace {

Mat3 frame_along(const Vec3& axis) {
  return rotation_between(Vec3::UnitZ(), axis).toRotationMatrix();
}

TrackingModel two_sensors() {
  TrackingModel model;
  for (int body : {0, 1}) model.sensors.push_back({.name = "s", .body = body});
  model.bodies = {TrackingBody{.sensor = 0}};
  model.covariance = MatrixXd::Zero(0, 0);
  return model;
}

/// Two sensors with a universal joint between them; the axes in the base, where both angles are zero.
FilterModel universal_between(const Vec3& first, const Vec3& second) {
  TrackingModel model = two_sensors();
  model.sensors[1].body = 2;
  model.bodies.push_back({.parent = 0,
                          .joint = 0,
                          .motion = TrackingMotion::revolute,
                          .parent_R_axis = frame_along(first),
                          .child_R_axis = frame_along(first)});
  model.bodies.push_back({.parent = 1,
                          .sensor = 1,
                          .joint = 0,
                          .motion = TrackingMotion::revolute,
                          .parent_R_axis = frame_along(second),
                          .child_R_axis = frame_along(second)});
  model.joints = {{.name = "universal", .positions = 2}};
  return filter_model(model);
}

FilterModel ball_between() {
  TrackingModel model = two_sensors();
  model.bodies.push_back({.parent = 0, .sensor = 1, .joint = 0, .motion = TrackingMotion::spherical});
  model.joints = {{.name = "ball", .positions = 3}};
  return filter_model(model);
}

/// What resting sensors measure where the joint has these angles, with noise as the start expects it.
BlockMeasurement resting_at(const FilterModel& model, double first, double second, Rng* rng = nullptr) {
  ChainState state = initial_state(model);
  state.joints[0] = first, state.joints[position_states] = second;
  const VectorXd value = predicted_measurement(model, state);
  BlockMeasurement block{.time = 0.0, .length = 0.02, .sensors = {}};
  for (Index s = 0; s < 2; ++s) {
    BlockSample sample{.rate_count = 1, .force_count = 1};
    sample.force = value.segment<3>(sensor_rows * s + 3);
    if (rng) sample.force += min_force_sd * normal_vector(*rng);
    block.sensors.push_back(sample);
  }
  return block;
}

std::vector<PositionGuess> guesses_at(double first, double second) {
  return {{.value = first, .sd = max_position_sd}, {.value = second, .sd = max_position_sd}};
}

PositionGuess given_at(double value) {
  return {.value = value, .sd = given_start_sd, .is_given = true};
}

double position(const InitialPosture& posture, Index i) {
  return posture.state.joints[position_states * i];
}

double sd_of(const InitialPosture& posture, const FilterModel& model, Index i) {
  const Index at = model.layout.joint_state(i);
  return std::sqrt(posture.covariance(at, at));
}

/// Where both axes are level and across each other gravity shows both angles; the first counted as unobservable there.
TEST(InitialPosture, GravityShowsAUniversalJointWithLevelAxes) {
  const FilterModel model = universal_between(Vec3::UnitX(), Vec3::UnitY());
  Rng rng(2);
  for (const double first : {0.0, 0.3, -0.7})
    for (const double second : {0.0, -0.2, 0.9}) {
      const InitialPosture found = initial_posture(model, resting_at(model, first, second, &rng),
                                                   guesses_at(first + 0.1, second - 0.1), BaseMode::still);
      for (Index i = 0; i < 2; ++i) {
        EXPECT_TRUE(found.positions[static_cast<std::size_t>(i)].is_known) << first << " " << second << " " << i;
        EXPECT_LT(sd_of(found, model, i), 0.02);
        EXPECT_LT(std::abs(position(found, i) - (i == 0 ? first : second)), 4.0 * sd_of(found, model, i));
      }
    }
}

TEST(InitialPosture, AnUprightFirstAxisOfAUniversalJointIsUnobservable) {
  const FilterModel model = universal_between(Vec3::UnitZ(), Vec3::UnitY());
  const InitialPosture found =
      initial_posture(model, resting_at(model, 0.4, 0.2), guesses_at(0.0, 0.0), BaseMode::still);
  EXPECT_FALSE(found.positions[0].is_known);
  EXPECT_TRUE(found.positions[1].is_known);
  EXPECT_NEAR(position(found, 1), 0.2, 1e-6);
}

/// Where gravity lies in the plane of both axes both solutions for the first angle meet, and it is seen by its square.
TEST(InitialPosture, AUniversalJointIsUncertainWhereItsTwoSolutionsMeet) {
  const FilterModel model = universal_between(Vec3(1.0, 0.0, 1.0).normalized(), Vec3(-1.0, 0.0, 1.0).normalized());
  Rng rng(3);
  constexpr int rounds = 200;
  double squares = 0.0, variance = 0.0;
  for (int k = 0; k < rounds; ++k) {
    const InitialPosture found =
        initial_posture(model, resting_at(model, 0.0, 0.3, &rng), guesses_at(0.0, 0.3), BaseMode::still);
    EXPECT_TRUE(found.positions[0].is_known);
    squares += std::pow(position(found, 0), 2) / rounds;
    variance += std::pow(sd_of(found, model, 0), 2) / rounds;
    for (Index i = 0; i < 2; ++i)
      EXPECT_LT(std::abs(position(found, i) - (i == 0 ? 0.0 : 0.3)), 4.0 * sd_of(found, model, i)) << i;
  }
  EXPECT_LT(squares, 1.5 * variance);
  EXPECT_GT(squares, 0.1 * variance);
}

TEST(InitialPosture, TakesTheUsersStartOfAUniversalJointWhereGravityShowsLess) {
  const FilterModel upright = universal_between(Vec3::UnitZ(), Vec3::UnitY());
  std::vector<PositionGuess> guesses = guesses_at(0.0, 0.0);
  guesses[0] = given_at(0.5);
  const InitialPosture found = initial_posture(upright, resting_at(upright, 0.4, 0.2), guesses, BaseMode::still);
  EXPECT_EQ(position(found, 0), 0.5);
  EXPECT_NEAR(sd_of(found, upright, 0), given_start_sd, 1e-12);
  EXPECT_TRUE(found.positions[0].is_known);
  EXPECT_NEAR(position(found, 1), 0.2, 1e-6);
}

TEST(InitialPosture, SaysThatTheUsersStartOfAUniversalJointIsWrong) {
  const FilterModel level = universal_between(Vec3::UnitX(), Vec3::UnitY());
  for (std::size_t i = 0; i < 2; ++i) {
    std::vector<PositionGuess> guesses = guesses_at(0.3, -0.2);
    guesses[i] = given_at(guesses[i].value + 0.5);
    const InitialPosture found = initial_posture(level, resting_at(level, 0.3, -0.2), guesses, BaseMode::still);
    EXPECT_GT(found.positions[i].contradicts_given, wrong_start_log_odds) << i;
    EXPECT_NEAR(position(found, 0), 0.3, 1e-6);
    EXPECT_NEAR(position(found, 1), -0.2, 1e-6);
  }
}

/// As exact as it is stated, and no better.
TEST(InitialPosture, AGivenHeadingOfABallIsAsUncertainAsItIsStated) {
  const FilterModel model = ball_between();
  const std::vector<PositionGuess> guesses(3, given_at(0.0));
  for (const BaseMode base : {BaseMode::still, BaseMode::moving}) {
    const InitialPosture found = initial_posture(model, resting_at(model, 0.0, 0.0), guesses, base);
    EXPECT_TRUE(found.positions[2].is_known);
    EXPECT_NEAR(sd_of(found, model, 2), given_start_sd, 1e-6) << "the heading";
  }
}

}  // namespace
}  // namespace kinfer::track
