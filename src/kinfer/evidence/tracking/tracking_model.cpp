// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/tracking/tracking_model.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kinfer/base/expect.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

int count(std::size_t size) {
  return static_cast<int>(size);
}

double prior_sd(const TrackingPrior& prior, TrackingParameterKind kind) {
  switch (kind) {
    case TrackingParameterKind::parent_rotation:
    case TrackingParameterKind::child_rotation:
      return prior.rotation;
    case TrackingParameterKind::point_in_parent:
    case TrackingParameterKind::point_in_child:
      return prior.point;
    case TrackingParameterKind::gyroscope_bias:
      return prior.bias.rate;
    case TrackingParameterKind::accelerometer_bias:
      return prior.bias.force;
    case TrackingParameterKind::gyroscope_scale:
      return prior.scale.rate;
    case TrackingParameterKind::accelerometer_scale:
      return prior.scale.force;
  }
  return 0.0;
}

}  // namespace

std::string_view name(TrackingMotion motion) {
  constexpr std::array<std::string_view, 4> names{"fixed", "revolute", "prismatic", "spherical"};
  return names[static_cast<std::size_t>(motion)];
}

int degrees_of_freedom(TrackingMotion motion) {
  constexpr std::array<int, 4> counts{0, 1, 1, 3};
  return counts[static_cast<std::size_t>(motion)];
}

std::string_view name(TrackingParameterKind kind) {
  constexpr std::array<std::string_view, 8> names{"parent_rotation", "child_rotation",     "point_in_parent",
                                                  "point_in_child",  "gyroscope_bias",     "accelerometer_bias",
                                                  "gyroscope_scale", "accelerometer_scale"};
  return names[static_cast<std::size_t>(kind)];
}

double largest_deviation(TrackingParameterKind kind) {
  switch (kind) {
    case TrackingParameterKind::point_in_parent:
    case TrackingParameterKind::point_in_child:
      return 1e5;  // [m]
    case TrackingParameterKind::accelerometer_bias:
      return 1e3;  // [m/s²]
    case TrackingParameterKind::parent_rotation:
    case TrackingParameterKind::child_rotation:
    case TrackingParameterKind::gyroscope_bias:
    case TrackingParameterKind::gyroscope_scale:
    case TrackingParameterKind::accelerometer_scale:
      break;
  }
  return 100.0;  // [rad], [rad/s], [1]
}

TrackingModel with_limited_deviations(TrackingModel model) {
  constexpr double share = 0.1;  // of the largest possible; the rest is left to the rounding of a file
  const VectorXd sd = model.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  VectorXd factors = VectorXd::Ones(sd.size());
  for (Eigen::Index i = 0; i < sd.size(); ++i) {
    const double limit = share * largest_deviation(model.parameters[static_cast<std::size_t>(i)].kind);
    if (sd[i] > limit) factors[i] = limit / sd[i];
  }
  model.covariance = factors.asDiagonal() * model.covariance * factors.asDiagonal();
  return model;
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

MatrixXd hidden_directions(const TrackingModel& model) {
  constexpr double hidden_share = 0.5;  // of the prior's variance
  const auto size = static_cast<Eigen::Index>(model.parameters.size());
  VectorXd scale(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const double sd = prior_sd(model.prior, model.parameters[static_cast<std::size_t>(i)].kind);
    scale[i] = sd > 0.0 ? 1.0 / sd : 0.0;
  }
  const SymmetricEigen eigen = symmetric_eigen(scale.asDiagonal() * model.covariance * scale.asDiagonal());
  const auto known = std::ranges::count_if(eigen.values, [](double value) { return value <= hidden_share; });
  return eigen.vectors.rightCols(size - known);
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
  KINFER_EXPECT(model.tool.body < count(model.bodies.size()));
}

}  // namespace kinfer
