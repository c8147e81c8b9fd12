// SPDX-License-Identifier: Apache-2.0
// A tracking model with one joint of each type in a tree, all numbers different.
#pragma once

#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/linalg/products.hpp"
#include "support/random_bodies.hpp"

namespace kinfer::test {

inline TrackingSensor random_sensor(int index, int body, Rng& rng) {
  TrackingSensor s{.name = "ins" + std::to_string(index), .body = body};
  s.gyroscope_bias = 1e-3 * random_vector(rng);
  s.accelerometer_bias = 1e-2 * random_vector(rng);
  s.gyroscope_scale = 1e-3 * skew(random_vector(rng));
  s.accelerometer_scale = 1e-3 * skew(random_vector(rng)).cwiseAbs();
  s.noise = {1e-3, 0.01};
  s.residual = {2e-3, 0.02 + 1e-3 * rng.normal()};
  s.slow_residual = {3e-3, 0.03};
  s.sample_period = 0.005;
  s.mount_compliance = 1e-4 * skew(random_vector(rng));
  s.mount_stray = 0.01;
  s.clock_offset = 1e-3 * rng.normal();
  s.clock_offset_sd = 1e-5;
  return s;
}

/// ins0 carries a hinge to ins1 and a slide to ins2; ins1 a ball to ins3; ins2 a universal joint to ins4; ins4 is rigid
/// with ins5.
inline TrackingModel example_tracking_model(std::uint64_t seed) {
  Rng rng(seed);
  TrackingModel model;
  model.bodies.push_back({.sensor = 0});
  const auto add = [&](int parent, int sensor, TrackingMotion motion) {
    TrackingBody body{.parent = parent,
                      .sensor = sensor,
                      .joint = static_cast<int>(model.joints.size()),
                      .motion = motion,
                      .parent_R_axis = random_rotation(rng),
                      .child_R_axis = random_rotation(rng),
                      .point_in_parent = random_vector(rng),
                      .point_in_child = random_vector(rng)};
    model.bodies.push_back(body);
    return static_cast<int>(model.bodies.size()) - 1;
  };
  const auto join = [&](const char* name, EstimatedJointType type, int positions) {
    TrackingJoint joint{.name = name, .type = type, .first_position = model.positions(), .positions = positions};
    for (int i = 0; i < positions; ++i) joint.range.push_back({-1.0 * i - 0.5, 1.0, 2.0, 3.0 + i});
    model.joints.push_back(joint);
  };
  const int hinge = add(0, 1, TrackingMotion::revolute);
  join("ins0-ins1", EstimatedJointType::revolute, 1);
  model.joints.back().stray = 0.02;
  model.joints.back().stray_time = 0.3;
  const int slide = add(0, 2, TrackingMotion::prismatic);
  join("ins0-ins2", EstimatedJointType::prismatic, 1);
  add(hinge, 3, TrackingMotion::spherical);
  join("ins1-ins3", EstimatedJointType::spherical, 3);
  const int middle = add(slide, -1, TrackingMotion::revolute);
  const int cross = add(middle, 4, TrackingMotion::revolute);
  join("ins2-ins4", EstimatedJointType::universal, 2);
  add(cross, 5, TrackingMotion::fixed);
  join("ins4-ins5", EstimatedJointType::rigid, 0);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    if (const int sensor = model.bodies[static_cast<std::size_t>(b)].sensor; sensor >= 0)
      model.sensors.push_back(random_sensor(sensor, b, rng));
  model.prior = {1.0, 3.0, {4e-3, 1e-2}, {5e-4, 3e-4}, {4e-5, 3e-4}, 90.0};
  model.base = {true, {0.1, 0.2, 9.8}, 0.4, 0.5};
  model.gravity = 9.8123;
  model.gravity_sd = 0.001;
  model.tool = {cross, {random_rotation(rng), random_vector(rng)}, {0.001, 0.002, 0.003}};
  for (int b = 1; b <= 3; ++b)
    for (int i = 0; i < 3; ++i) model.parameters.push_back({TrackingParameterKind::point_in_parent, b, i});
  for (int s = 0; s < 6; ++s)
    for (int i = 0; i < 9; ++i) model.parameters.push_back({TrackingParameterKind::gyroscope_scale, s, i});
  const auto size = static_cast<Eigen::Index>(model.parameters.size());
  MatrixXd root(size, size);
  for (double& value : root.reshaped()) value = 1e-2 * rng.normal();
  root.row(0) *= 300.0;  // nearly unknown
  model.covariance = times_transposed(root, root);
  return model;
}

}  // namespace kinfer::test
