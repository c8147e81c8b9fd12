// SPDX-License-Identifier: Apache-2.0
// A tracking model with one joint of each type in a tree, all geometry free, and random states of its filter.
#pragma once

#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/track/model/chain_state.hpp"
#include "support/random.hpp"

namespace kinfer::test {

inline Mat3 random_turn(Rng& rng) {
  return exp_so3(random_vector(rng));
}

inline TrackingBody random_body(int parent, int sensor, int joint, TrackingMotion motion, Rng& rng) {
  TrackingBody body{.parent = parent, .sensor = sensor, .joint = joint, .motion = motion};
  body.parent_R_axis = random_turn(rng);
  body.child_R_axis = random_turn(rng);
  body.point_in_parent = random_vector(rng);
  body.point_in_child = random_vector(rng);
  return body;
}

/// A tree: hinge, universal joint, slide, ball, fixed segment; the ball hangs beside the slide. Nothing of it is known
/// to better than 1 rad or 1 m: the hinge's zero, its axis near the vertical, the turn of its segment and all points
/// are unseen, but for a hinge that is known.
inline TrackingModel random_tree(Rng& rng, bool has_known_hinge = false) {
  using Kind = TrackingParameterKind;
  TrackingModel model;
  model.bodies = {TrackingBody{.sensor = 0},
                  random_body(0, 1, 0, TrackingMotion::revolute, rng),
                  random_body(1, -1, 1, TrackingMotion::revolute, rng),
                  random_body(2, 2, 1, TrackingMotion::revolute, rng),
                  random_body(3, 3, 2, TrackingMotion::prismatic, rng),
                  random_body(3, 4, 3, TrackingMotion::spherical, rng),
                  random_body(4, 5, 4, TrackingMotion::fixed, rng)};
  model.joints = {{.name = "hinge"},
                  {.name = "universal", .first_position = 1, .positions = 2},
                  {.name = "slide", .first_position = 3},
                  {.name = "ball", .first_position = 4, .positions = 3},
                  {.name = "fixed", .first_position = 7, .positions = 0}};
  for (int b = 0; b < 7; ++b) {
    const int sensor = model.bodies[static_cast<std::size_t>(b)].sensor;
    if (sensor >= 0) {
      TrackingSensor made{.name = "s", .body = b};
      made.gyroscope_bias = 0.1 * random_vector(rng);
      made.accelerometer_bias = 0.1 * random_vector(rng);
      made.gyroscope_scale = 0.1 * random_turn(rng);
      made.accelerometer_scale = 0.1 * random_turn(rng);
      model.sensors.push_back(made);
    }
    if (b == 0) continue;
    for (int c = 0; c < (b == 1 && !has_known_hinge ? 3 : 2); ++c)
      model.parameters.push_back({Kind::child_rotation, b, c});
    for (int c = 0; c < 2; ++c) model.parameters.push_back({Kind::parent_rotation, b, c});
    for (int c = 0; c < 3; ++c) model.parameters.push_back({Kind::point_in_child, b, c});
    for (int c = 0; c < 3; ++c) model.parameters.push_back({Kind::point_in_parent, b, c});
  }
  model.base.force = standard_gravity * model.bodies[1].parent_R_axis * rot_x(0.1).col(2);
  const auto n = static_cast<Eigen::Index>(model.parameters.size());
  model.covariance = MatrixXd::Identity(n, n);
  return model;
}

inline track::ChainState random_state(const track::FilterModel& model, Rng& rng) {
  track::ChainState state = initial_state(model);
  state.base = track::BaseMode::moving;
  state.world_R_base = random_turn(rng);
  state.rate = random_vector(rng);
  state.angular_acceleration = random_vector(rng);
  state.velocity = random_vector(rng);
  state.acceleration = random_vector(rng);
  for (Eigen::Index i = 0; i < state.joints.size(); ++i) state.joints[i] = random_vector(rng).x();
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (model.bodies[b].motion == JointMotion::spherical) {
      state.spherical[b] = random_turn(rng);
      for (Eigen::Index k = 0; k < 3; ++k) state.joints[track::position_states * (model.layout.position[b] + k)] = 0.0;
    }
  for (const track::UnknownZero& zero : model.unknown_zeros) state.start[zero.position] = random_vector(rng).x();
  for (const track::UnknownTurn& turn : model.unknown_turns)
    state.turned[static_cast<Eigen::Index>(turn.body)] = random_vector(rng).x();
  for (const track::UnknownAxis& axis : model.unknown_axes) state.tilted[axis.body] = exp_so3(0.3 * random_vector(rng));
  for (const track::UnknownPoint& point : model.unknown_points) state.moved[point.body] = random_vector(rng);
  return state;
}

}  // namespace kinfer::test
