// SPDX-License-Identifier: Apache-2.0
// A stick with sensors on it: no sensor moves relative to another.
#include <gmock/gmock.h>

#include "identify/driven_machine.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/words/identification/verdict.hpp"

namespace kinfer {
using namespace identify;
namespace {

using test::DrivenMachine;
using test::identified;

/// Sensors at one place of a rigid body that is waved about, in different mountings and with noise of their own.
InsRecording stick() {
  const DrivenMachine drive = test::driven_machine("excavator-general", 5, Script::together);
  const InsSensor& carried = drive.recording.sensors[3];
  InsRecording recording{.loggers = drive.recording.loggers, .sensors = {}};
  Rng rng(7);
  for (const char* name : {"a", "b", "c"}) {
    InsSensor sensor = carried;
    sensor.name = name;
    Vec3 turn;
    for (double& angle : turn) angle = rng.normal();
    const Mat3 mounting = exp_so3(turn);
    const auto mount = [&](TriadColumns& triad, double noise) {
      for (std::size_t row = 0; row < sensor.rows(); ++row) {
        const Vec3 turned = mounting * triad.at(row);
        for (std::size_t k = 0; k < 3; ++k)
          triad.axis[k][row] = static_cast<float>(turned[static_cast<Eigen::Index>(k)] + noise * rng.normal());
      }
    };
    mount(sensor.acceleration, 0.01);
    mount(sensor.angular_velocity, 0.001);
    mount(sensor.field, 0.1);
    recording.sensors.push_back(std::move(sensor));
  }
  return recording;
}

TEST(OneBody, IsNotToBeUsedAndSaidToBeOneBody) {
  const Identification found = identified(stick());
  EXPECT_EQ(found.usability, Usability::do_not_use);
  ASSERT_EQ(found.joints.size(), 2u);
  for (const JointEstimate& joint : found.joints) EXPECT_EQ(joint.type, EstimatedJointType::rigid);
  EXPECT_THAT(words::identification_verdict(found),
              testing::HasSubstr("no sensor certainly moves relative to another: all of them on one body"));
}

}  // namespace
}  // namespace kinfer
