// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/session.hpp"

#include <gmock/gmock.h>

#include "identify/driven_machine.hpp"

namespace kinfer {
using namespace identify;
namespace {

Result<Session> opened(const InsRecording& recording, const std::vector<std::string>& sensors = {}) {
  return Session::open(recording, sensors, {}, {}, 0);
}

TEST(Session, UsesAllSensorsThatMoveAndTheNamedOnesOnly) {
  const InsRecording recording = test::driven_machine("excavator", 1).recording;
  const auto all = opened(recording), some = opened(recording, {"ins2", "ins1"});
  ASSERT_TRUE(all && some);
  EXPECT_EQ(all->recording().sensors.size(), 6U);
  EXPECT_TRUE(all->findings().empty());
  ASSERT_EQ(some->recording().sensors.size(), 2U);
  EXPECT_FALSE(opened(recording, {"nobody"}));
}

TEST(Session, RefusesASensorWithoutGyro) {
  InsRecording recording = test::driven_machine("excavator", 1).recording;
  recording.sensors[2].angular_velocity = {};
  EXPECT_THAT(opened(recording).error().what, testing::HasSubstr("ins2: identification needs specific force"));
}

TEST(Session, IsRestrictedToSensorsAndTimeAtMostSixTimes) {
  const InsRecording recording = test::driven_machine("excavator", 1).recording;
  auto session = opened(recording);
  ASSERT_TRUE(session);
  RecordingSelection part = select_all(6);
  part.sensors = {0, 1, 3};
  part.begin = 5.0;
  ASSERT_TRUE(session->restrict_to(part));
  ASSERT_EQ(session->recording().sensors.size(), 3U);
  EXPECT_EQ(session->recording().sensors[2].name, "ins3");
  EXPECT_GE(session->recording().time(session->recording().sensors[0]).front(), 5.0);
  for (int i = 1; i < 6; ++i) ASSERT_TRUE(session->restrict_to(select_all(3)));
  EXPECT_FALSE(session->restrict_to(select_all(3)));
}

}  // namespace
}  // namespace kinfer
