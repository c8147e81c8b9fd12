// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/fact_resolution.hpp"

#include <gtest/gtest.h>

namespace kinfer {
using namespace identify;
namespace {

/// Sensors base, boom, wrist and slide: a revolute, a universal and a prismatic joint in series, 10 .. 20 s.
struct NamedMachine {
  std::vector<std::string> sensors{"slide", "base", "boom", "wrist"};
  InsBodies bodies{{.sensor = 1},
                   revolute_body(0, 2, Mat3::Identity(), Mat3::Identity()),
                   revolute_body(1, -1, Mat3::Identity(), Mat3::Identity()),
                   revolute_body(2, 3, Mat3::Identity(), Mat3::Identity()),
                   prismatic_body(3, 0, Mat3::Identity(), Mat3::Identity())};
  SplineGrid grid{.begin = 10.0, .period = 0.1, .intervals = 100};

  Result<InsFacts> resolved(const MachineMeasurements& facts, bool root_at_rest = true) const {
    return resolve_facts(facts, sensors, bodies, grid, root_at_rest);
  }
  std::string refusal(const MachineMeasurements& facts, bool root_at_rest = true) const {
    const auto result = resolved(facts, root_at_rest);
    return result ? "(accepted)" : result.error().what;
  }
};

MachineMeasurements taped(const std::string& from, const std::string& to, std::optional<HoldSegment> at = {}) {
  MachineMeasurements facts;
  facts.tapes.push_back({.from = from, .to = to, .length = 1.5, .sigma = 2e-3, .at = at});
  return facts;
}

TEST(ResolveFacts, NamesAreSensorsJointsOrPlaces) {
  MachineMeasurements facts = taped("base", "base-boom");
  facts.tapes.push_back({.from = "boom-wrist", .to = "tip", .length = 0.3, .sigma = 1e-3, .at = {}});
  facts.places.push_back({.name = "bolt", .sensor = "boom", .xyz = Vec3(0.1, 0.2, 0.3), .sigma = 4e-3});
  facts.places.push_back({.name = "tip", .sensor = "slide", .xyz = {}});
  const auto all = NamedMachine().resolved(facts);
  ASSERT_TRUE(all) << all.error().what;
  using Kind = InsPoint::Kind;
  EXPECT_EQ(all->tapes[0].from.kind, Kind::sensor);
  EXPECT_EQ(all->tapes[0].from.body, 0);
  EXPECT_EQ(all->tapes[0].to.kind, Kind::joint_axis);
  EXPECT_EQ(all->tapes[0].to.body, 1);
  EXPECT_EQ(all->tapes[1].from.kind, Kind::joint_centre) << "a universal joint has a centre";
  EXPECT_EQ(all->tapes[1].from.body, 2) << "the first body of the joint";
  EXPECT_EQ(all->tapes[1].to.kind, Kind::place);
  EXPECT_EQ(all->tapes[1].to.body, 4);
  EXPECT_EQ(all->tapes[1].to.place, 1);
  ASSERT_EQ(all->places.size(), 2U);
  EXPECT_EQ(all->places[0].start, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(all->places[0].sd, 4e-3);
  EXPECT_EQ(all->places[1].sd, InsUnknownPoint{}.sd) << "unknown but for the weak prior";
}

TEST(ResolveFacts, ABallJointHasACentre) {
  NamedMachine machine;
  machine.bodies[1] = spherical_body(0, 2, Mat3::Identity());
  const auto all = machine.resolved(taped("base", "base-boom"));
  ASSERT_TRUE(all) << all.error().what;
  EXPECT_EQ(all->tapes[0].to.kind, InsPoint::Kind::joint_centre);
  EXPECT_EQ(all->tapes[0].to.body, 1);
}

TEST(ResolveFacts, ATimeIsTheMiddleOfItsWindowAndWithoutOneTheBegin) {
  const NamedMachine machine;
  EXPECT_DOUBLE_EQ(machine.resolved(taped("base", "boom"))->tapes[0].at, 10.0);
  EXPECT_DOUBLE_EQ(machine.resolved(taped("base", "boom", HoldSegment{12.0, 13.0}))->tapes[0].at, 12.5);
  EXPECT_EQ(machine.refusal(taped("base", "boom", HoldSegment{19.0, 20.5})),
            "tape 1: 19 .. 20.5 s: outside the recording, which spans 10.00 .. 20.00 s");
  EXPECT_EQ(machine.refusal(taped("base", "boom", HoldSegment{9.9, 12.0})),
            "tape 1: 9.9 .. 12 s: outside the recording, which spans 10.00 .. 20.00 s");
}

TEST(ResolveFacts, WhatNamesNothingIsAnErrorWithTheNamesThereAre) {
  const NamedMachine machine;
  EXPECT_EQ(
      machine.refusal(taped("base", "arm")),
      "tape 1: no sensor, joint or [[place]] is called \"arm\"; the joints are base-boom, boom-wrist, wrist-slide");
  EXPECT_EQ(machine.refusal(taped("wrist-slide", "base")),
            "tape 1: wrist-slide: only joints that rotate have a point for a tape measurement");
  MachineMeasurements facts;
  facts.places.push_back({.name = "tip", .sensor = "arm", .xyz = {}});
  EXPECT_EQ(machine.refusal(facts), "place tip: no sensor is called \"arm\"");
}

TEST(ResolveFacts, ATouchHasOneTimeForEachWindow) {
  MachineMeasurements facts;
  facts.touches.push_back({.point = "slide", .at = {{11.0, 11.2}, {15.0, 15.4}, {18.0, 18.0}}, .sigma = 1e-3});
  const auto all = NamedMachine().resolved(facts);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->touches[0].point.body, 4);
  ASSERT_EQ(all->touches[0].at.size(), 3U);
  EXPECT_NEAR(all->touches[0].at[1], 15.2, 1e-12);
  EXPECT_EQ(all->touches[0].sd, 1e-3);
}

TEST(ResolveFacts, OnAMovingBaseOnlyTapesMakeSense) {
  const NamedMachine machine;
  EXPECT_EQ(machine.refusal(taped("base", "boom"), false), "(accepted)");
  MachineMeasurements touched;
  touched.touches.push_back({.point = "slide", .at = {{11.0, 11.2}, {15.0, 15.4}}, .sigma = 1e-3});
  EXPECT_EQ(machine.refusal(touched, false), "touches and surveyed points need a machine with a stationary base");
}

TEST(ResolveFacts, ASurveyNeedsThreePoints) {
  const NamedMachine machine;
  MachineMeasurements facts;
  for (const int count : {1, 2, 3}) {
    facts.surveys.push_back({.point = "slide", .at = {11.0, 12.0}, .xyz = Vec3(1.0, 2.0, 3.0), .sigma = 1e-3});
    EXPECT_EQ(machine.refusal(facts) == "(accepted)", count == 3) << count;
  }
  facts.surveys.resize(1);
  EXPECT_EQ(machine.refusal(facts), "1 surveyed point: at least 3 are needed to place the surveyor's frame");
}

TEST(ResolveFacts, NoFactsAreNone) {
  const auto none = NamedMachine().resolved({}, false);
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->places.empty() && none->tapes.empty() && none->touches.empty() && none->surveyed.empty());
}

}  // namespace
}  // namespace kinfer
