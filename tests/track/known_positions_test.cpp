// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/start/known_positions.hpp"

#include <gtest/gtest.h>

#include "kinfer/track/model/thresholds.hpp"

namespace kinfer::track {
namespace {

/// An upright hinge on the base, and another on it.
FilterModel two_hinges() {
  TrackingModel model;
  model.bodies.push_back({.sensor = 0});
  for (int b = 1; b < 3; ++b) {
    model.bodies.push_back({.parent = b - 1, .sensor = b, .joint = b - 1, .motion = TrackingMotion::revolute});
    model.joints.push_back(
        {.name = "hinge", .type = EstimatedJointType::revolute, .first_position = b - 1, .positions = 1});
  }
  for (int s = 0; s < 3; ++s) model.sensors.push_back({.name = "ins", .body = s});
  return filter_model(model);
}

/// Gravity shows the second hinge alone.
KnownPositions begun(const FilterModel& model, BaseMode base) {
  InitialPosture posture;
  posture.positions = {StartPosition{}, StartPosition{.is_known = true}};
  KnownPositions positions(model);
  positions.begin(model, posture, base);
  return positions;
}

TEST(KnownPositions, OfAStillBaseCountFromTheStart) {
  const FilterModel model = two_hinges();
  const KnownPositions positions = begun(model, BaseMode::still);
  EXPECT_FALSE(positions[0].is_known);
  EXPECT_FALSE(positions[0].is_open);
  EXPECT_EQ(positions[0].missing_sd(), 0.0);  // of what counts from the start
  EXPECT_EQ(positions.start_sd(model, 1), max_position_sd);
  EXPECT_TRUE(positions[1].is_known);
  EXPECT_EQ(positions.start_sd(model, 2), 0.0);
}

TEST(KnownPositions, AreShownByAMovingBase) {
  const FilterModel model = two_hinges();
  KnownPositions positions = begun(model, BaseMode::still);
  positions.let_base_move(model);
  EXPECT_TRUE(positions[0].is_open);
  EXPECT_FALSE(positions[1].is_open);
  EXPECT_EQ(positions[0].missing_sd(), max_position_sd);
  EXPECT_TRUE(begun(model, BaseMode::moving)[0].is_open);
  positions.decide(model, 1);
  EXPECT_TRUE(positions[0].is_known);
  EXPECT_EQ(positions[0].missing_sd(), 0.0);
  EXPECT_EQ(positions.start_sd(model, 1), 0.0);
}

TEST(KnownPositions, ThatWereLostAreNoBetterKnownThanBefore) {
  const FilterModel model = two_hinges();
  KnownPositions positions = begun(model, BaseMode::still);
  for (const Index i : {0, 1}) positions.lose(i, 0.5, BaseMode::still);
  EXPECT_EQ(positions.start_sd(model, 1), max_position_sd);
  EXPECT_EQ(positions.start_sd(model, 2), 0.5);
  for (const std::size_t i : {0U, 1U}) {
    EXPECT_FALSE(positions[i].is_known);
    EXPECT_EQ(positions[i].missing_sd(), 0.5);
  }
  positions.lose(1, 1e3, BaseMode::moving);
  EXPECT_TRUE(positions[1].is_open);
  EXPECT_EQ(positions[1].missing_sd(), max_position_sd);
}

}  // namespace
}  // namespace kinfer::track
