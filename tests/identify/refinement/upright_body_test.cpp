// SPDX-License-Identifier: Apache-2.0
// A parallel linkage: a body that the second joint turns back by what the first one turns, and an arm on it. Where in
// that body its joints are changes no signal.
#include <gtest/gtest.h>

#include "identify/hand_moved_chain.hpp"
#include "kinfer/evidence/identification/unobservable_limit.hpp"

namespace kinfer {
using namespace identify;
namespace {

struct UprightBody {
  InsBodies bodies{{.sensor = 0},
                   revolute_body(0, 1, frame_with_z_along(Vec3::UnitY()), frame_with_z_along(Vec3::UnitY())),
                   revolute_body(1, 2, frame_with_z_along(Vec3::UnitY()), frame_with_z_along(Vec3::UnitY())),
                   revolute_body(2, 3, frame_with_z_along(Vec3::UnitY()), frame_with_z_along(Vec3::UnitY()))};
  InsRecording recording;

  explicit UprightBody(std::uint64_t seed) {
    bodies[1].point_in_parent = Vec3(0.3, 0.0, 0.2), bodies[1].point_in_child = Vec3(-0.6, 0.0, 0.1);
    bodies[2].point_in_parent = Vec3(0.7, 0.0, 0.05), bodies[2].point_in_child = Vec3(-0.5, 0.0, 0.1);
    bodies[3].point_in_parent = Vec3(0.6, 0.0, 0.1), bodies[3].point_in_child = Vec3(-0.3, 0.0, 0.05);
    recording.loggers = {{.name = "log", .time = {}}};
    for (const char* name : {"a", "b", "c", "d"})
      recording.sensors.push_back(
          {.name = name, .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}});
    Rng rng(seed);
    for (int row = 0; row < 3000; ++row) {
      const double t = 0.01 * row, start = std::min(1.0, std::max(0.0, t - 2.0));
      recording.loggers[0].time.push_back(t);
      std::vector<InsState> states(1);
      states[0].force = Vec3(0.0, 0.0, 9.81);
      const auto swing = test::wave(0.5 * start, 0.41, 0.0, t), arm = test::wave(0.4 * start, 0.57, 0.5, t);
      const auto back = test::wave(-0.5 * start, 0.41, 0.0, t);
      states.push_back(propagated(bodies[1], test::readings({swing, {}, {}}), states[0]));
      states.push_back(propagated(bodies[2], test::readings({back, {}, {}}), states[1]));
      states.push_back(propagated(bodies[3], test::readings({arm, {}, {}}), states[2]));
      for (std::size_t s = 0; s < states.size(); ++s) test::HandMovedChain::put(recording.sensors[s], states[s], rng);
    }
  }
};

double line_sd(const std::array<double, 2>& sd) {
  return std::hypot(sd[0], sd[1]);
}

TEST(UprightBody, TheNoiseOfItsRotationTellsNothingOfItsLeverArms) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Refinement found = test::refined(UprightBody(seed).recording, 2);
    ASSERT_EQ(found.joints.size(), 3u);
    const JointStandardDeviation &first = found.joints[0].estimate.sd, &second = found.joints[1].estimate.sd,
                                 &third = found.joints[2].estimate.sd;
    EXPECT_LT(line_sd(first.point_in_child), 5e-3);
    EXPECT_LT(line_sd(second.point_in_parent), 5e-3);
    EXPECT_GT(line_sd(second.point_in_child), unobservable_sd) << seed;
    EXPECT_GT(line_sd(third.point_in_parent), unobservable_sd) << seed;
    EXPECT_LT(line_sd(third.point_in_child), 5e-3);
  }
}

}  // namespace
}  // namespace kinfer
