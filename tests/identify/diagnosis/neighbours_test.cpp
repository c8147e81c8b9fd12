// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/diagnosis/neighbours.hpp"

#include "identify/driven_machine.hpp"
#include "kinfer/identify/diagnosis/diagnosis.hpp"

namespace kinfer::identify {
namespace {

Mat3 exchanged_axes() {
  Mat3 axes = Mat3::Zero();
  axes(0, 2) = axes(1, 1) = axes(2, 0) = 1.0;
  return axes;
}

InsSensor with_axes(InsSensor sensor, const Mat3& axes) {
  transform(sensor.angular_velocity, 1.0, axes);
  return sensor;
}

TEST(Neighbours, ContradictAWrongMapOfAxesThatTheSensorItselfFavours) {
  const InsRecording sound = test::driven_machine("excavator", 3).recording;
  const InsSensor& sensor = sound.sensors[2];
  const AxesChoice choice = choose_axes(sound, 2, {{sensor, 0.0}, {with_axes(sensor, exchanged_axes()), 240.0}}, 1);
  EXPECT_EQ(choice.candidate, 0U);
}

TEST(Neighbours, ChooseTheTrueMapOfAxesThatTheSensorItselfDoesNotFavour) {
  const InsRecording sound = test::driven_machine("excavator", 3).recording;
  InsRecording faulty = sound;
  faulty.sensors[2] = with_axes(sound.sensors[2], exchanged_axes());
  const Mat3 turned = Vec3(1, -1, -1).asDiagonal();
  const AxesChoice choice = choose_axes(
      faulty, 2, {{faulty.sensors[2], 0.0}, {with_axes(faulty.sensors[2], turned), 160.0}, {sound.sensors[2], 90.0}},
      1);
  EXPECT_EQ(choice.candidate, 2U);
  EXPECT_GT(choice.gain(), 1000.0);
}

TEST(Neighbours, MapTheAxesOfASensorThatSharesNoJointWithoutThem) {
  const InsRecording sound = test::driven_machine("excavator", 3).recording;
  InsRecording faulty = sound;
  faulty.sensors[3] = with_axes(sound.sensors[3], exchanged_axes());
  LogDiagnosis diagnosis;
  ASSERT_TRUE(mend_unconnected_axes(diagnosis, faulty, faulty, {3}, 1));
  EXPECT_EQ(diagnosis.findings.size(), 1U);
  EXPECT_EQ(diagnosis.mended->sensors[3].angular_velocity.axis[0][500], sound.sensors[3].angular_velocity.axis[0][500]);
  EXPECT_FALSE(mend_unconnected_axes(diagnosis, faulty, *diagnosis.mended, {3}, 1)) << "it is asked about once";
}

TEST(Neighbours, WantNoOtherAxesOfASoundSensor) {
  const InsRecording sound = test::driven_machine("excavator", 3).recording;
  LogDiagnosis diagnosis;
  EXPECT_FALSE(mend_unconnected_axes(diagnosis, sound, sound, {2}, 1));
  EXPECT_FALSE(diagnosis.mended);
}

}  // namespace
}  // namespace kinfer::identify
