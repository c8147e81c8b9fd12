// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/diagnosis/neighbours.hpp"

#include "identify/driven_machine.hpp"

namespace kinfer::identify {
namespace {

Finding axes_of(const InsSensor& sensor) {
  return {
      .kind = FindingKind::instrument_axes,
      .severity = Severity::fault,
      .values = {{"sensor", sensor.name}, {"instrument", std::string("gyroscope")}, {"axes", std::string("z, y, x")}},
      .applied = true};
}

Mat3 exchanged_axes() {
  Mat3 axes = Mat3::Zero();
  axes(0, 2) = axes(1, 1) = axes(2, 0) = 1.0;
  return axes;
}

TEST(Neighbours, TakeBackAMapOfAxesThatTheyContradict) {
  const InsRecording sound = test::driven_machine("excavator", 3).recording;
  MendedLog log(sound);
  transform(log.edit().sensors[2].angular_velocity, 1.0, exchanged_axes());
  log.findings = {axes_of(sound.sensors[2])};
  withdraw_contradicted_maps(log, {{2, sound.sensors[2]}}, 1);
  EXPECT_TRUE(log.findings.empty());
  EXPECT_EQ(log.log().sensors[2].angular_velocity.axis[0][500], sound.sensors[2].angular_velocity.axis[0][500]);
}

TEST(Neighbours, LeaveATrueMapOfAxes) {
  const InsRecording sound = test::driven_machine("excavator", 3).recording;
  InsRecording faulty = sound;
  transform(faulty.sensors[2].angular_velocity, 1.0, exchanged_axes());
  MendedLog log(faulty);
  transform(log.edit().sensors[2].angular_velocity, 1.0, exchanged_axes());
  log.findings = {axes_of(sound.sensors[2])};
  withdraw_contradicted_maps(log, {{2, faulty.sensors[2]}}, 1);
  EXPECT_EQ(log.findings.size(), 1U);
}

}  // namespace
}  // namespace kinfer::identify
