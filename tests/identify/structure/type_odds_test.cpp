// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/type_odds.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "kinfer/base/angle.hpp"

namespace kinfer {
using namespace identify;
namespace {

using enum EstimatedJointType;

/// Deviations [deg] of a joint whose accelerations fit a common point, on segments that rotate by 1 rad/s.
MotionDeviations turning(double rotation, double axis, double plane, double axes_angle, double rate_share) {
  constexpr double noise = 5e-4, explained_by_scales = 0.01;
  return {.rotation = Angle::deg(rotation).rad(),
          .axis = Angle::deg(axis).rad(),
          .plane = Angle::deg(plane).rad(),
          .axes_angle = Angle::deg(axes_angle).rad(),
          .rate_share = rate_share,
          .rates = {.residual = std::max(rate_share - explained_by_scales, noise), .noise = noise, .level = 1.0},
          .acceleration = 0.02,
          .acceleration_across = 0.015};
}

const MotionDeviations revolute_joint = turning(11.0, 0.04, 0.02, 0.1, 0.8), ball = turning(11.0, 9.0, 4.6, 30.0, 0.6),
                       universal_joint = turning(10.0, 6.2, 0.06, 70.0, 0.7),
                       clamped = turning(0.1, 0.04, 0.02, 0.1, 0.01);

std::vector<EstimatedJointType> types_of(const std::vector<MotionDeviations>& joints) {
  std::vector<EstimatedJointType> types;
  for (const JointTypeProbabilities& p : type_probabilities(joints)) types.push_back(most_probable(p));
  return types;
}

TEST(TypeOdds, ABallIsABallWhereverItStandsAndWhateverItsNeighboursAre) {
  EXPECT_EQ(types_of({revolute_joint, ball}), (std::vector{revolute, spherical}));
  EXPECT_EQ(types_of({ball, revolute_joint, universal_joint}), (std::vector{spherical, revolute, universal}));
  EXPECT_EQ(types_of({ball, ball, ball}), (std::vector{spherical, spherical, spherical}));
}

TEST(TypeOdds, WhatAllJointsOfARecordingHaveIsErrorOfItsMounts) {
  const MotionDeviations on_foam = turning(6.0, 1.9, 1.0, 2.0, 0.6);
  EXPECT_EQ(types_of({on_foam, on_foam, on_foam, on_foam}), std::vector(4, revolute));
  const auto soft = type_probabilities(std::vector(4, on_foam))[0],
             among_rigid = type_probabilities(std::vector{revolute_joint, revolute_joint, revolute_joint, on_foam})[3];
  EXPECT_GT(soft.of(revolute), among_rigid.of(revolute));
}

TEST(TypeOdds, AccelerationsAboveThoseOfTheOtherJointsAreASlider) {
  MotionDeviations slider = clamped;
  slider.acceleration = 0.092;  // with Coriolis accelerations across it
  slider.acceleration_across = 0.046;
  MotionDeviations quiet = revolute_joint;
  quiet.acceleration = 0.0043;
  quiet.acceleration_across = 0.0038;
  EXPECT_EQ(types_of({quiet, slider}), (std::vector{revolute, prismatic}));
  EXPECT_EQ(types_of({revolute_joint, clamped}), (std::vector{revolute, rigid}));
}

TEST(TypeOdds, AHingeThatHardlyMovesIsNoneOfTheGyroscopesErrors) {
  MotionDeviations hinge = turning(1.2, 0.04, 0.02, 0.1, 0.04), scales = turning(0.3, 0.1, 0.05, 0.1, 0.02);
  scales.rates.residual = scales.rates.noise;
  const auto p = type_probabilities(std::vector{revolute_joint, hinge, scales});
  EXPECT_GT(p[1].of(revolute), 0.95);
  EXPECT_GT(p[2].of(rigid), 0.5);
}

TEST(TypeOdds, ProbabilitiesSumToOne) {
  for (const JointTypeProbabilities& p :
       type_probabilities(std::vector{revolute_joint, ball, universal_joint, clamped})) {
    double sum = 0.0;
    for (const double probability : p.of_type) sum += probability;
    EXPECT_NEAR(sum, 1.0, 1e-9);
  }
  EXPECT_TRUE(type_probabilities({}).empty());
}

}  // namespace
}  // namespace kinfer
