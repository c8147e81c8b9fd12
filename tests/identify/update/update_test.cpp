// SPDX-License-Identifier: Apache-2.0
// A machine that is identified from one drive and updated by another one.
#include <gtest/gtest.h>

#include <numbers>

#include "identify/driven_machine.hpp"
#include "kinfer/base/angle.hpp"

namespace kinfer {
using namespace identify;
namespace {

constexpr std::uint64_t machine_seed = 4;
constexpr std::size_t most_sensors = 5;  // all but the wrist of an arm

/// A drive of the machine; `pin`: [m] by which the joint of `body` is farther out on its parent.
test::DrivenMachine drive_of(const std::string& name, std::uint64_t seed, const std::string& body = "",
                             double pin = 0.0) {
  std::string mjcf = *machine_mjcf(name, {.mounting = Mounting::arbitrary}, Rng(machine_seed));
  if (!body.empty()) {
    const std::size_t begin = mjcf.find("pos=\"", mjcf.find("<body name=\"" + body + "\"")) + 5,
                      end = mjcf.find_first_of(" \"", begin);
    mjcf.replace(begin, end - begin, fmt::format("{}", std::stod(mjcf.substr(begin, end - begin)) + pin));
  }
  const MujocoWorld world = std::move(*MujocoWorld::load(mjcf));
  const MachineMotion motion = world.prescribe(test::drive_of(world.machine(), {}, seed), 100.0);
  return test::first_sensors({simulate_recording(world.machine(), motion, *sensor_grade("industrial"), {}, Rng(seed)),
                              machine_truth(world.machine(), motion)},
                             most_sensors);
}

/// As if the sensor sat on its segment turned by an angle.
void turn(InsRecording& recording, const std::string& sensor, const Vec3& angle) {
  InsSensor& turned = *std::ranges::find(recording.sensors, sensor, &InsSensor::name);
  for (TriadColumns* columns : {&turned.acceleration, &turned.angular_velocity, &turned.field})
    for (std::size_t row = 0; row < columns->axis[0].size(); ++row) {
      const Vec3 value = exp_so3(angle).transpose() * columns->at(row);
      for (std::size_t k = 0; k < 3; ++k)
        columns->axis[k][row] = static_cast<float>(value[static_cast<Eigen::Index>(k)]);
    }
}

Identification updated(const Identification& known, const InsRecording& recording) {
  IdentifyOptions options;
  options.refine.known = known.tracking;
  return test::identified(recording, options);
}

double sum_of_variances(const Identification& found) {
  double sum = 0.0;
  for (const JointEstimate& joint : found.joints)
    sum +=
        joint.sd.axis_in_child[0] * joint.sd.axis_in_child[0] + joint.sd.axis_in_child[1] * joint.sd.axis_in_child[1];
  return sum;
}

std::vector<std::string> changes_of(const Identification& found) {
  std::vector<std::string> names;
  for (const ChainChange& change : found.update->changes) names.push_back(change.name);
  return names;
}

TEST(Update, JoinsTwoLogsOfTheSameMachineAndNamesATurnedSensor) {
  const Identification known = test::identified(drive_of("crane", 11).recording);
  test::DrivenMachine again = drive_of("crane", 12);
  const Identification same = updated(known, again.recording), alone = test::identified(again.recording);
  ASSERT_TRUE(same.update);
  EXPECT_EQ(changes_of(same), std::vector<std::string>{});
  EXPECT_NE(same.usability, Usability::do_not_use);
  EXPECT_LT(sum_of_variances(same), 0.8 * sum_of_variances(alone)) << "both logs tell more than one";
  EXPECT_LT(test::worst_line_error(same.joints, again.truth), 0.02);
  EXPECT_EQ(position_names(*same.tracking), active_joint_names(same.chain));

  turn(again.recording, "ins2", Vec3(0.6, -0.6, 0.5).normalized() * degree);
  const Identification turned = updated(known, again.recording);
  ASSERT_TRUE(turned.update);
  EXPECT_EQ(changes_of(turned), std::vector<std::string>{"ins2"});
  const ChainChange& change = turned.update->changes.front();
  EXPECT_EQ(change.kind, ChainChangeKind::sensor_moved);
  ASSERT_TRUE(change.angle);
  EXPECT_NEAR(change.angle->value, degree, 3.0 * change.angle->sd);
}

/// The same machine, the positions of all joints with a single axis counted the other way.
TrackingModel with_reversed_axes(TrackingModel model) {
  const auto is_reversed = [](const TrackingBody& body) {
    return body.motion == TrackingMotion::revolute || body.motion == TrackingMotion::prismatic;
  };
  for (TrackingBody& body : model.bodies)
    if (is_reversed(body))
      body.parent_R_axis = body.parent_R_axis * rot_x(std::numbers::pi),
      body.child_R_axis = body.child_R_axis * rot_x(std::numbers::pi);
  VectorXd sign = VectorXd::Ones(std::ssize(model.parameters));
  for (std::size_t i = 0; i < model.parameters.size(); ++i) {
    const TrackingParameter& p = model.parameters[i];
    const bool rotates =
        p.kind == TrackingParameterKind::parent_rotation || p.kind == TrackingParameterKind::child_rotation;
    if (rotates && p.component > 0 && is_reversed(model.bodies[static_cast<std::size_t>(p.index)]))
      sign[static_cast<Eigen::Index>(i)] = -1.0;
  }
  model.covariance = sign.asDiagonal() * model.covariance * sign.asDiagonal();
  return model;
}

TEST(Update, KeepsTheSenseOfTheKnownAxes) {
  Identification known = test::identified(drive_of("crane", 11).recording);
  known.tracking = with_reversed_axes(*known.tracking);
  const Identification found = updated(known, drive_of("crane", 12).recording);
  ASSERT_TRUE(found.update);
  EXPECT_EQ(changes_of(found), std::vector<std::string>{});
  for (std::size_t j = 0; j < known.joints.size(); ++j)
    EXPECT_LT(found.joints[j].axis_in_child.dot(known.joints[j].axis_in_child), -0.9) << j;
}

TEST(Update, NamesAMovedPinAndRefusesAnotherMachine) {
  const Identification known = test::identified(drive_of("robot6", 11).recording);
  const Identification moved = updated(known, drive_of("robot6", 12, "forearm", 0.02).recording);
  ASSERT_TRUE(moved.update);
  ASSERT_EQ(moved.update->changes.size(), 1u);
  const ChainChange& change = moved.update->changes.front();
  EXPECT_EQ(change.kind, ChainChangeKind::joint_moved);
  EXPECT_EQ(change.name, "ins3-ins4");
  ASSERT_TRUE(change.distance);
  EXPECT_NEAR(change.distance->value, 0.02, 3.0 * change.distance->sd);

  const auto other = test::first_sensors(test::driven_machine("robot6", 77), most_sensors);
  EXPECT_EQ(updated(known, other.recording).usability, Usability::do_not_use);
  const auto smaller =
      identify_machine(test::driven_arm(3, 4).recording, {.refine = {.known = known.tracking}}, Rng(1));
  ASSERT_FALSE(smaller);
  EXPECT_NE(smaller.error().what.find("no sensor"), std::string::npos) << smaller.error().what;
}

}  // namespace
}  // namespace kinfer
