// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/tracking/tracking_model.hpp"

#include <fmt/format.h>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

int count(std::size_t size) {
  return static_cast<int>(size);
}

}  // namespace

std::string_view name(BodyMotion motion) {
  constexpr std::array<std::string_view, 4> names{"fixed", "revolute", "prismatic", "spherical"};
  return names[static_cast<std::size_t>(motion)];
}

int degrees_of_freedom(BodyMotion motion) {
  constexpr std::array<int, 4> counts{0, 1, 1, 3};
  return counts[static_cast<std::size_t>(motion)];
}

std::string_view name(TrackingParameterKind kind) {
  constexpr std::array<std::string_view, 8> names{"parent_rotation", "child_rotation",     "point_in_parent",
                                                  "point_in_child",  "gyroscope_bias",     "accelerometer_bias",
                                                  "gyroscope_scale", "accelerometer_scale"};
  return names[static_cast<std::size_t>(kind)];
}

int TrackingModel::positions() const {
  int sum = 0;
  for (const TrackingJoint& joint : joints) sum += joint.positions;
  return sum;
}

std::vector<std::string> position_names(const TrackingModel& model) {
  std::vector<std::string> names;
  for (const TrackingJoint& joint : model.joints)
    for (int i = 0; i < joint.positions; ++i)
      names.push_back(joint.positions == 1 ? joint.name : fmt::format("{} {}", joint.name, i + 1));
  return names;
}

void expect_well_formed(const TrackingModel& model) {
  KINFER_EXPECT(!model.bodies.empty() && model.bodies.front().parent == -1);
  for (int b = 0; b < count(model.bodies.size()); ++b) {
    const TrackingBody& body = model.bodies[static_cast<std::size_t>(b)];
    KINFER_EXPECT(b == 0 || (body.parent >= 0 && body.parent < b), "body {} has parent {}", b, body.parent);
    KINFER_EXPECT(body.sensor < count(model.sensors.size()) && body.joint < count(model.joints.size()));
  }
  for (const TrackingSensor& sensor : model.sensors)
    KINFER_EXPECT(sensor.body >= 0 && sensor.body < count(model.bodies.size()), "{} on body {}", sensor.name,
                  sensor.body);
  const auto size = static_cast<Eigen::Index>(model.parameters.size());
  KINFER_EXPECT(model.covariance.rows() == size && model.covariance.cols() == size);
  KINFER_EXPECT(model.hidden.cols() == 0 || model.hidden.rows() == size);
  KINFER_EXPECT(model.tool.body < count(model.bodies.size()));
}

}  // namespace kinfer
