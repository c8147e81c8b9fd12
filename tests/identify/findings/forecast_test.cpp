// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/findings/forecast.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinfer/identify/pipeline.hpp"
#include "kinfer/simulate/ground_truth.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "kinfer/simulate/machine_from_chain.hpp"
#include "kinfer/simulate/prescribed_motion.hpp"
#include "kinfer/words/identification/forecast.hpp"
#include "simulate/worlds.hpp"

namespace kinfer {
using namespace identify;
namespace {

JointEstimate joint_with(double point_sd, double axis_sd) {
  JointEstimate joint{.parent = "a", .child = "b"};
  joint.sd.point_in_parent = joint.sd.point_in_child = {0.1 * point_sd, point_sd};
  joint.sd.axis_in_parent = joint.sd.axis_in_child = {axis_sd, axis_sd};
  return joint;
}

TEST(Forecast, UnobservableQuantitiesDoNotCount) {
  JointEstimate joint = joint_with(2e-3, 1e-4);
  joint.sd.point_in_parent = {3.0, 3.0};  // of a parent that does not rotate
  joint.unobservable_in_parent = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  const auto all = forecast({joint});
  ASSERT_EQ(all.size(), 1U);
  EXPECT_DOUBLE_EQ(all[0].line_sd, std::hypot(2e-4, 2e-3));
  EXPECT_TRUE(all[0].is_sufficient);
}

TEST(Forecast, TheRecommendedFactorsJustReachTheTarget) {
  const JointForecast lacking = forecast({joint_with(1e-2, 1e-4)}).front();
  EXPECT_FALSE(lacking.is_sufficient);
  EXPECT_NEAR(lacking.acceleration_factor, 1.96 * std::hypot(1e-3, 1e-2) / 5e-3, 1e-12);
  EXPECT_NEAR(lacking.time_factor, lacking.acceleration_factor * lacking.acceleration_factor, 1e-12);
  EXPECT_TRUE(forecast({joint_with(1e-2 / lacking.acceleration_factor * 0.999, 1e-4)}).front().is_sufficient);
  EXPECT_EQ(words::forecast_text({lacking}, {}),
            "not enough for 5 mm and 3 mrad in a-b (3.9 times the acceleration, or 15.5 times the time)");
}

TEST(Forecast, TheRecommendedDurationIsBounded) {
  const JointForecast hopeless = forecast({joint_with(0.1, 1e-4)}).front();
  EXPECT_FALSE(hopeless.more_excitation_suffices);
  EXPECT_EQ(words::forecast_text({hopeless}, {}),
            "not enough for 5 mm and 3 mrad in a-b (± 100 mm and ± 0 mrad, which a longer recording does not improve "
            "enough)");
}

TEST(Forecast, AJointOfWhichNothingIsKnownIsNeverEnough) {
  JointEstimate joint = joint_with(1.0, 1e-4);
  joint.sd.point_in_child = {1.0, 1.0};  // as of joints whose geometry was not fitted
  const JointForecast line = forecast({joint}).front();
  EXPECT_FALSE(is_determined(line));
  EXPECT_FALSE(line.is_sufficient);
  EXPECT_EQ(words::forecast_text({line}, {}), "not enough for 5 mm and 3 mrad in a-b (unknown)");
  EXPECT_EQ(words::accuracy_text({line}), "");
  EXPECT_FALSE(forecast({joint_with(1e-3, 1.0)}).front().is_sufficient) << "its axis is unknown";
  joint = joint_with(1e-3, std::numeric_limits<double>::infinity());
  EXPECT_FALSE(forecast({joint}).front().is_sufficient) << "as of joints that were withdrawn";
  joint.type = EstimatedJointType::spherical;
  EXPECT_TRUE(forecast({joint}).front().is_sufficient) << "a spherical joint has no axis";
}

TEST(Forecast, ALineThatIsKnownWorseIsNotKnownBetter) {
  double before = 0.0;
  for (const double sd : {0.01, 0.2, 0.3, 0.49, 0.51, 0.94, 10.0}) {
    JointEstimate joint = joint_with(1e-3, 1e-4);
    joint.unobservable_in_parent = {Vec3::UnitX()};
    joint.sd.point_in_child = {1e-3, sd};  // known across one direction, hardly across the other
    const JointForecast line = forecast({joint}).front();
    EXPECT_GE(line.line_sd, before) << sd;
    EXPECT_FALSE(line.is_sufficient) << sd;
    before = line.line_sd;
  }
  EXPECT_TRUE(std::isinf(before));
}

TEST(Forecast, AChildThatNeverTurnsHasItsPointInTheParent) {
  JointEstimate joint = joint_with(1.0, 1e-4);
  joint.sd.point_in_child = {1.0, 1.0};
  joint.sd.point_in_parent = {1e-3, 1e-3};
  joint.unobservable_in_child = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  EXPECT_TRUE(forecast({joint}).front().is_sufficient);
  joint.sd.point_in_parent = {1.0, 1.0};
  EXPECT_FALSE(forecast({joint}).front().is_sufficient);
}

TEST(Forecast, TheAzimuthIsReportedSeparately) {
  JointEstimate joint = joint_with(1e-3, 1e-4);
  joint.sd.axis_in_parent = {3e-3, 4e-3};
  EXPECT_FALSE(forecast({joint}).front().is_sufficient);
  joint.unobservable_in_parent = {Vec3::UnitZ()};
  const JointForecast apart = forecast({joint}).front();
  EXPECT_TRUE(apart.is_sufficient);
  EXPECT_EQ(apart.azimuth_of, "a");
  EXPECT_DOUBLE_EQ(apart.azimuth_sd, 5e-3);
  EXPECT_TRUE(apart.azimuth_is_uncertain);
  EXPECT_EQ(words::forecast_text({apart}, {}),
            "enough for 5 mm and 3 mrad in every joint, except for positions that are unobservable from this recording "
            "and the azimuth of a about its only axis (± 5 mrad)");
  const AccuracyTarget coarse{.direction = 0.01};
  EXPECT_EQ(
      words::forecast_text(forecast({joint}, coarse), coarse),
      "enough for 5 mm and 10 mrad in every joint, except for positions that are unobservable from this recording");
}

/// An identified chain is driven in simulation and identified again.
TEST(Forecast, AnIdentifiedChainIsSimulatedAndIdentifiedAgain) {
  const MujocoWorld world = test::world_of("excavator-general", {}, 3);
  const MachineMotion motion = world.prescribe(test::drive_of(world.machine(), {.script = Script::together}), 100.0);
  const auto found =
      identify_machine(simulate_recording(world.machine(), motion, *sensor_grade("noise"), {}, Rng(1)), {}, Rng(1));
  ASSERT_TRUE(found) << found.error().what;
  const auto machine = make_machine(found->chain);
  ASSERT_TRUE(machine) << machine.error().what;
  EXPECT_EQ(machine->sensors.size(), 6U);
  EXPECT_EQ(machine->sensors.front().name, "ins0");
  const auto drive = make_drive(*machine, {.script = Script::together}, Rng(2));
  const auto again = identify_machine(
      simulate_recording(*machine, prescribed_motion(*machine, *drive, 100.0), *sensor_grade("noise"), {}, Rng(2)), {},
      Rng(1));
  ASSERT_TRUE(again) << again.error().what;
  ASSERT_EQ(again->joints.size(), found->joints.size());
  for (const JointEstimate& joint : again->joints)
    EXPECT_TRUE(std::ranges::any_of(
        found->joints, [&](const JointEstimate& j) { return j.parent == joint.parent && j.child == joint.child; }));
  ASSERT_EQ(again->links.size(), found->links.size());
  for (const LinkEstimate& link : again->links) {
    const auto same =
        std::ranges::find(found->links, link.from + link.to, [](const LinkEstimate& l) { return l.from + l.to; });
    ASSERT_NE(same, found->links.end()) << link.segment;
    // Axes half a degree from parallel have their common normal far away, and its sd shows that.
    EXPECT_NEAR(link.length, same->length, 4.0 * std::hypot(link.sd, same->sd)) << link.segment;
  }
}

}  // namespace
}  // namespace kinfer
