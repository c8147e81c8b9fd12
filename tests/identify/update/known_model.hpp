// SPDX-License-Identifier: Apache-2.0
// A machine with a joint of every type as identifications would find it, again and again, with errors drawn from a
// stated covariance.
#pragma once

#include <fmt/format.h>

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/random.hpp"
#include "kinfer/identify/update/aligned_bodies.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::test {
using namespace identify;

/// [rad], [m] Standard deviations of an identification's axes and points.
inline constexpr double model_axis_sd = 2e-4, model_point_sd = 1e-3;

struct ModelJoint {
  EstimatedJointType type;
  int parent;  ///< sensor
};

inline TrackingBody some_body(TrackingMotion motion, int parent, int sensor, int joint, Rng& rng) {
  TrackingBody body{.parent = parent, .sensor = sensor, .joint = joint, .motion = motion};
  body.parent_R_axis = random_orientation(rng).toRotationMatrix();
  body.child_R_axis = random_orientation(rng).toRotationMatrix();
  body.point_in_parent = normal_vector(rng);
  if (motion == TrackingMotion::prismatic || motion == TrackingMotion::fixed) return body;
  body.point_in_child = normal_vector(rng);
  if (motion == TrackingMotion::revolute)
    body.point_in_child -= body.child_R_axis.col(2) * body.child_R_axis.col(2).dot(body.point_in_child);
  return body;
}

inline void add_parameters(TrackingModel& model, TrackingParameterKind kind, int index, std::initializer_list<int> of) {
  for (const int component : of) model.parameters.push_back({kind, index, component});
}

inline void add_body(TrackingModel& model, const TrackingBody& body, bool is_second_of_universal = false,
                     bool is_first_of_universal = false) {
  using Kind = TrackingParameterKind;
  const int index = static_cast<int>(model.bodies.size());
  model.bodies.push_back(body);
  const bool rotates = body.motion == TrackingMotion::revolute, slides = body.motion == TrackingMotion::prismatic;
  if (is_second_of_universal)
    add_parameters(model, Kind::parent_rotation, index, {1});
  else if (rotates || slides)
    add_parameters(model, Kind::parent_rotation, index, {0, 1});
  if (slides || body.motion == TrackingMotion::fixed)
    add_parameters(model, Kind::child_rotation, index, {0, 1, 2});
  else if (rotates && !is_first_of_universal)
    add_parameters(model, Kind::child_rotation, index, {0, 1});
  if (!is_second_of_universal) add_parameters(model, Kind::point_in_parent, index, {0, 1, 2});
  if (!is_first_of_universal && (rotates || body.motion == TrackingMotion::spherical))
    add_parameters(model, Kind::point_in_child, index, {0, 1, 2});
  if (rotates) add_parameters(model, Kind::child_rotation, index, {2});
}

inline void add_joint(TrackingModel& model, const ModelJoint& joint, Rng& rng) {
  const int j = static_cast<int>(model.joints.size()), sensor = static_cast<int>(model.sensors.size());
  const int parent = model.sensors[static_cast<std::size_t>(joint.parent)].body;
  const std::string name = fmt::format("ins{}", sensor);
  TrackingJoint made{.name = fmt::format("ins{}-{}", joint.parent, name), .type = joint.type};
  made.first_position = model.positions();
  if (joint.type == EstimatedJointType::universal) {
    TrackingBody near = some_body(TrackingMotion::revolute, parent, -1, j, rng),
                 far = some_body(TrackingMotion::revolute, static_cast<int>(model.bodies.size()), sensor, j, rng);
    near.child_R_axis = rot_z(0.4);
    near.point_in_child.setZero();
    far.parent_R_axis = rot_y(1.4);
    far.point_in_parent.setZero();
    far.point_in_child = normal_vector(rng);
    add_body(model, near, false, true);
    add_body(model, far, true);
    made.positions = 2;
  } else {
    const TrackingMotion motion = joint.type == EstimatedJointType::revolute    ? TrackingMotion::revolute
                                  : joint.type == EstimatedJointType::prismatic ? TrackingMotion::prismatic
                                  : joint.type == EstimatedJointType::spherical ? TrackingMotion::spherical
                                                                                : TrackingMotion::fixed;
    TrackingBody body = some_body(motion, parent, sensor, j, rng);
    if (motion == TrackingMotion::fixed) body.parent_R_axis.setIdentity();
    add_body(model, body);
    made.positions = degrees_of_freedom(motion);
  }
  model.joints.push_back(made);
  model.sensors.push_back({.name = name, .body = static_cast<int>(model.bodies.size()) - 1});
}

/// Covariance of geometry, with correlations, and of biases and scale matrices.
inline void set_covariance(TrackingModel& model, double factor, Rng& rng) {
  const auto size = std::ssize(model.parameters);
  VectorXd sd(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const auto kind = model.parameters[static_cast<std::size_t>(i)].kind;
    const bool turns = kind == TrackingParameterKind::parent_rotation || kind == TrackingParameterKind::child_rotation;
    sd[i] = factor * (turns ? model_axis_sd : kind <= TrackingParameterKind::point_in_child ? model_point_sd : 1e-4);
  }
  MatrixXd mix = MatrixXd::Identity(size, size);
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index k = 0; k < size; ++k) mix(i, k) += 0.3 * rng.normal() / std::sqrt(static_cast<double>(size));
  const MatrixXd root = sd.asDiagonal() * mix;
  model.covariance = times_transposed(root, root);
}

inline TrackingModel known_model(const std::vector<ModelJoint>& joints, std::uint64_t seed) {
  Rng rng(seed);
  TrackingModel model;
  model.sensors.push_back({.name = "ins0"});
  model.bodies.push_back({.sensor = 0});
  for (const ModelJoint& joint : joints) add_joint(model, joint, rng);
  for (int s = 0; s < std::ssize(model.sensors); ++s) {
    add_parameters(model, TrackingParameterKind::gyroscope_bias, s, {0, 1, 2});
    add_parameters(model, TrackingParameterKind::accelerometer_bias, s, {0, 1, 2});
    add_parameters(model, TrackingParameterKind::accelerometer_scale, s, {0, 4, 8});
  }
  model.prior.bias = {0.01, 0.1};
  model.prior.scale = {0.01, 0.01};
  model.tool.body = static_cast<int>(model.bodies.size()) - 1;
  set_covariance(model, 1.0, rng);
  return model;
}

inline std::vector<ModelJoint> every_joint_type() {
  using enum EstimatedJointType;
  return {{revolute, 0}, {revolute, 1}, {universal, 2}, {prismatic, 2}, {spherical, 4}, {rigid, 1}, {revolute, 3}};
}

inline std::vector<ModelJoint> arm() {
  using enum EstimatedJointType;
  return {{revolute, 0}, {revolute, 1}, {revolute, 2}, {revolute, 3}};
}

/// An identification of the machine, wrong by a draw from its covariance, which is `factor`² times the model's.
inline TrackingModel identified_again(const TrackingModel& truth, double factor, std::uint64_t seed) {
  Rng rng(seed);
  TrackingModel model = truth;
  set_covariance(model, factor, rng);
  const auto size = std::ssize(model.parameters);
  VectorXd white(size);
  for (Eigen::Index i = 0; i < size; ++i) white[i] = rng.normal();
  const VectorXd error = *cholesky(model.covariance) * white;
  std::vector<BodyDifference> steps(model.bodies.size(), BodyDifference::Zero());
  for (Eigen::Index i = 0; i < size; ++i) {
    const TrackingParameter& p = model.parameters[static_cast<std::size_t>(i)];
    if (p.kind <= TrackingParameterKind::point_in_child)
      steps[static_cast<std::size_t>(p.index)][3 * static_cast<Eigen::Index>(p.kind) + p.component] = error[i];
  }
  for (std::size_t b = 0; b < model.bodies.size(); ++b) model.bodies[b] = retracted(model.bodies[b], steps[b]);
  return model;
}

}  // namespace kinfer::test
