// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/model/chain_state.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/square.hpp"
#include "kinfer/track/model/thresholds.hpp"

namespace kinfer::track {
namespace {

/// Transition of (q, q̇, q̈) over dt: q̈ decays with its correlation time. q̇ must not decay as well: the filter would
/// explain it by accelerations, and the position would lag (0.08° instead of 0.02° on simulated machines).
struct Transition {
  double velocity_from_acceleration, position_from_velocity, position_from_acceleration;
  double acceleration_decay;
};

Transition transition(double time, double dt) {
  const double e = std::exp(-dt / time), slid = time * (1.0 - e);
  return {slid, dt, time * (dt - slid), e};
}

bool is_between_rates(const AccelerationProcess& process, double dt, ShownMeans means) {
  return dt <= longest_bridge && means == ShownMeans::rates && !process.is_measured;
}

/// Of a velocity that counts as linear the position is the trapezoid. That of an acceleration which decays exceeds it
/// by q̈ dt³/12τ in each step, which adds up to q̇ dt²/12τ: positions led by 1e-4 s.
Transition transition(const AccelerationProcess& process, double dt, ShownMeans means) {
  Transition f = transition(process.time, dt);
  if (is_between_rates(process, dt, means)) f.position_from_acceleration = 0.5 * dt * f.velocity_from_acceleration;
  return f;
}

/// Integral of the driving noise over a step short against the correlation time (Singer 1970, its leading terms).
Mat3 driven(double density, double dt) {
  const double d2 = dt * dt, d3 = d2 * dt;
  Mat3 q;
  // clang-format off
  q << d2 * d3 / 20.0, d2 * d2 / 8.0, d3 / 6.0,
       d2 * d2 / 8.0,  d3 / 3.0,      d2 / 2.0,
       d3 / 6.0,       d2 / 2.0,      dt;
  // clang-format on
  return density * q;
}

/// The same where the velocity is measured itself, as the mean of each block: between the middles of two blocks it
/// counts as linear, so that positions follow from the means. The true integral of the mean rate is known, and `driven`
/// would add an error of the position of density·dt⁵/720 in each step, twice the sensors' own.
Mat3 driven_between_rates(double density, double dt) {
  Mat3 q = driven(density, dt);
  q(0, 0) = 0.25 * dt * dt * q(1, 1);
  q(0, 1) = q(1, 0) = 0.5 * dt * q(1, 1);
  q(0, 2) = q(2, 0) = 0.5 * dt * q(1, 2);
  return q;
}

/// Likewise where the acceleration alone is measured: it counts as linear, so that velocities follow from the means.
/// `driven` would add an error of the velocity of density·dt³/12 in each step, tenfold the sensors' own.
Mat3 driven_between_accelerations(double density, double dt) {
  const Vec3 by_change(dt * dt / 6.0, dt / 2.0, 1.0);
  return density * dt * by_change * by_change.transpose();
}

Mat3 driven(const AccelerationProcess& process, double dt, ShownMeans means) {
  const double density = process.density();
  if (dt <= longest_bridge && process.is_measured) return driven_between_accelerations(density, dt);
  if (is_between_rates(process, dt, means)) return driven_between_rates(density, dt);
  return driven(density, dt);
}

/// Applies the transition of a triple of states to columns of the covariance: columns ← columns Fᵀ.
void mix_columns(const Transition& f, Index rows, Index first, MatrixXd& p) {
  double *q = p.col(first).data(), *v = p.col(first + 1).data(), *a = p.col(first + 2).data();
  for (Index i = 0; i < rows; ++i) {
    q[i] += f.position_from_velocity * v[i] + f.position_from_acceleration * a[i];
    v[i] += f.velocity_from_acceleration * a[i];
    a[i] *= f.acceleration_decay;
  }
}

/// The velocity is the integral of the acceleration. It must not decay: with a decay of 1 s a tilt of 0.1° would show
/// as 0.017 m/s, and not as a velocity that grows until it is beyond what a base does.
struct BaseTransition {
  Mat3 turned;     ///< of the attitude's error
  Mat3 from_rate;  ///< of the attitude by the rate
  double rate_from, rate_decay, velocity_from, acceleration_decay, dt;
};

BaseTransition base_transition(const FilterModel& model, const ChainState& state, double dt) {
  const auto kept = [&](double time) { return std::exp(-dt / time); };
  BaseTransition f;
  const Vec3 turn = dt * state.rate;
  f.turned = exp_so3(-turn);
  f.from_rate = dt * right_jacobian(turn);
  f.rate_decay = kept(model.base_rotation.time);
  f.rate_from = model.base_rotation.time * (1.0 - f.rate_decay);
  f.acceleration_decay = kept(model.base_translation.time);
  f.velocity_from = model.base_translation.time * (1.0 - f.acceleration_decay);
  f.dt = dt;
  return f;
}

Eigen::Matrix<double, base_states, base_states> matrix_of(const BaseTransition& f) {
  Eigen::Matrix<double, base_states, base_states> m = Eigen::Matrix<double, base_states, base_states>::Zero();
  const Mat3 one = Mat3::Identity();
  m.block<3, 3>(0, 0) = f.turned;
  m.block<3, 3>(0, 3) = f.from_rate;
  m.block<3, 3>(0, 6) = 0.5 * f.dt * f.from_rate;
  m.block<3, 3>(3, 3) = one;
  m.block<3, 3>(3, 6) = f.rate_from * one;
  m.block<3, 3>(6, 6) = f.rate_decay * one;
  m.block<3, 3>(9, 9) = one;
  m.block<3, 3>(9, 12) = f.velocity_from * one;
  m.block<3, 3>(12, 12) = f.acceleration_decay * one;
  return m;
}

void add_base_noise(const FilterModel& model, double dt, MatrixXd& p) {
  const double turn = model.base_rotation.density(), push = model.base_translation.density();
  const Mat3 one = Mat3::Identity(), of_turn = driven(turn, dt), of_push = driven(push, dt);
  for (Index i = 0; i < 3; ++i)
    for (Index j = 0; j < 3; ++j) p.block<3, 3>(3 * i, 3 * j) += of_turn(i, j) * one;
  for (Index i = 0; i < 2; ++i)
    for (Index j = 0; j < 2; ++j)
      p.block<3, 3>(BaseIndex::velocity + 3 * i, BaseIndex::velocity + 3 * j) += of_push(i + 1, j + 1) * one;
}

/// P ← F P Fᵀ of the moving base.
void move_base(const FilterModel& model, const ChainState& state, double dt, MatrixXd& p) {
  const auto f = matrix_of(base_transition(model, state, dt));
  const Index n = p.rows();
  Eigen::Matrix<double, base_states, 1> column;
  for (Index j = 0; j < n; ++j) {
    column = p.col(j).head<base_states>();
    p.col(j).head<base_states>().noalias() = f * column;
  }
  for (Index j = base_states; j < n; ++j) p.row(j).head<base_states>() = p.col(j).head<base_states>().transpose();
  const Eigen::Matrix<double, base_states, base_states> left = p.topLeftCorner<base_states, base_states>();
  p.topLeftCorner<base_states, base_states>().noalias() = left * f.transpose();
}

/// The attitude's error of a spherical joint is in the rotating frame: its columns ← columns exp(−turn)ᵀ.
void turn_columns(const Mat3& back, Index first, MatrixXd& p) {
  for (Index i = 0; i < p.rows(); ++i) {
    const Vec3 row(p(i, first), p(i, first + position_states), p(i, first + 2 * position_states));
    const Vec3 turned = back * row;
    for (Index k = 0; k < 3; ++k) p(i, first + k * position_states) = turned[k];
  }
}

void turn_rows(const Mat3& back, Index first, Index begin, Index end, MatrixXd& p) {
  for (Index j = begin; j < end; ++j) {
    const Vec3 column(p(first, j), p(first + position_states, j), p(first + 2 * position_states, j));
    const Vec3 turned = back * column;
    for (Index k = 0; k < 3; ++k) p(first + k * position_states, j) = turned[k];
  }
}

/// exp(−turn) of a spherical joint over dt.
Mat3 turned_back(const ChainState& state, Index first, double dt) {
  Vec3 turn;
  for (Index k = 0; k < 3; ++k) turn[k] = -dt * state.joints[position_states * (first + k) + 1];
  return exp_so3(turn);
}

void rotate_spherical(const FilterModel& model, std::size_t body, const Vec3& turn, ChainState& state) {
  if (model.bodies[body].motion == JointMotion::spherical) state.spherical[body] *= exp_so3(turn);
}

}  // namespace

InsState ChainState::base_state(double gravity) const {
  InsState s;
  s.angular_velocity = rate;
  s.angular_acceleration = angular_acceleration;
  s.force = world_R_base.transpose() * Vec3(acceleration + Vec3(0.0, 0.0, gravity));
  return s;
}

ChainState initial_state(const FilterModel& model) {
  const FilterLayout& layout = model.layout;
  ChainState state;
  state.joints = VectorXd::Zero(position_states * layout.positions);
  state.liveliness = VectorXd::Zero(layout.positions);
  state.start = VectorXd::Zero(layout.positions);
  state.turned = VectorXd::Zero(static_cast<Index>(model.bodies.size()));
  state.tilted.assign(model.bodies.size(), Mat3::Identity());
  state.moved.assign(model.bodies.size(), Vec3::Zero());
  state.spherical.assign(model.bodies.size(), Mat3::Identity());
  for (const SensorSettings& s : model.sensors)
    state.sensors.push_back({s.gyroscope_bias, s.accelerometer_bias, s.gyroscope_scale, s.accelerometer_scale});
  return state;
}

ParentSide parent_side(const FilterModel& model, const ChainState& state, std::size_t b) {
  const InsBody& body = model.bodies[b];
  const auto parent = static_cast<std::size_t>(body.parent);
  const Vec3 point = body.point_in_parent + state.moved[b];
  const Mat3 parent_R_axis = state.tilted[b] * body.parent_R_axis;
  if (!model.unknown_turn(b)) return {parent_R_axis, point};
  const InsBody& segment = model.bodies[parent];
  const Mat3 turn = exp_so3(state.turned[static_cast<Index>(b)] * segment.child_R_axis.col(2));
  return {turn * parent_R_axis, segment.point_in_child + turn * (point - segment.point_in_child), turn};
}

FilterModel turned_model(const FilterModel& model, const ChainState& state) {
  FilterModel turned = model;
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const ParentSide side = parent_side(model, state, b);
    turned.bodies[b].parent_R_axis = side.parent_R_axis;
    turned.bodies[b].point_in_parent = side.point_in_parent;
  }
  return turned;
}

void retract(const FilterModel& model, const VectorXd& error, ChainState& state) {
  const FilterLayout& layout = model.layout;
  state.world_R_base *= exp_so3(error.segment<3>(BaseIndex::attitude));
  state.rate += error.segment<3>(BaseIndex::rate);
  state.angular_acceleration += error.segment<3>(BaseIndex::angular_acceleration);
  state.velocity += error.segment<3>(BaseIndex::velocity);
  state.acceleration += error.segment<3>(BaseIndex::acceleration);
  state.joints += error.segment(base_states, state.joints.size());
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    if (model.bodies[b].motion != JointMotion::spherical) continue;
    Vec3 turn;
    for (Index i = 0; i < 3; ++i) {
      double& q = state.joints[position_states * (layout.position[b] + i)];
      turn[i] = q;
      q = 0.0;
    }
    rotate_spherical(model, b, turn, state);
  }
  for (const UnknownZero& zero : model.unknown_zeros) state.start[zero.position] += error[zero.state];
  for (const UnknownAxis& axis : model.unknown_axes)
    state.tilted[axis.body] *=
        exp_so3(model.bodies[axis.body].parent_R_axis.leftCols<2>() * error.segment<2>(axis.state));
  for (const UnknownPoint& point : model.unknown_points) state.moved[point.body] += error.segment<3>(point.state);
  for (const UnknownTurn& turn : model.unknown_turns) state.turned[static_cast<Index>(turn.body)] += error[turn.state];
  for (std::size_t s = 0; s < state.sensors.size(); ++s) {
    const Index first = layout.sensor_state(static_cast<Index>(s));
    SensorErrors& e = state.sensors[s];
    e.gyroscope_bias += error.segment<3>(first + SensorIndex::gyroscope_bias);
    e.accelerometer_bias += error.segment<3>(first + SensorIndex::accelerometer_bias);
    for (Index k = 0; k < 9; ++k) {
      e.gyroscope_scale(k / 3, k % 3) += error[first + SensorIndex::gyroscope_scale + k];
      e.accelerometer_scale(k / 3, k % 3) += error[first + SensorIndex::accelerometer_scale + k];
    }
  }
}

void predict_mean(const FilterModel& model, double dt, ChainState& state, ShownMeans means) {
  state.time += dt;
  if (state.base == BaseMode::moving) {
    const BaseTransition f = base_transition(model, state, dt);
    state.world_R_base *= exp_so3(dt * (state.rate + 0.5 * dt * state.angular_acceleration));
    state.rate += f.rate_from * state.angular_acceleration;
    state.angular_acceleration *= f.rate_decay;
    state.velocity += f.velocity_from * state.acceleration;
    state.acceleration *= f.acceleration_decay;
  }
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const Index first = model.layout.position[b], dof = degrees_of_freedom(model.bodies[b].motion);
    Vec3 turn = Vec3::Zero();
    for (Index i = 0; i < dof; ++i) {
      double* x = state.joints.data() + position_states * (first + i);
      const Transition f = transition(model.positions[static_cast<std::size_t>(first + i)], dt, means);
      double& liveliness = state.liveliness[first + i];
      liveliness += (square(x[2]) - liveliness) * (1.0 - std::exp(-dt / liveliness_time));
      turn[i] = f.position_from_velocity * x[1] + f.position_from_acceleration * x[2];
      if (dof == 1) x[0] += turn[i];
      x[1] += f.velocity_from_acceleration * x[2];
      x[2] *= f.acceleration_decay;
    }
    rotate_spherical(model, b, turn, state);
  }
}

namespace {

/// The process of a joint that turns, as lively as it has been lately.
AccelerationProcess lively(AccelerationProcess process, double mean_square) {
  if (!process.is_measured) process.sd = std::max(process.sd, std::sqrt(mean_square));
  return process;
}

}  // namespace

void predict_error(const FilterModel& model, const ChainState& state, double dt, MatrixXd& errors, ShownMeans means) {
  if (state.base == BaseMode::moving) {
    const auto f = matrix_of(base_transition(model, state, dt));
    Eigen::Matrix<double, 1, base_states> row;
    for (Index i = 0; i < errors.rows(); ++i) {
      row = errors.row(i).head<base_states>();
      errors.row(i).head<base_states>().noalias() = row * f.transpose();
    }
  }
  for (std::size_t b = 1; b < model.bodies.size(); ++b)
    if (model.bodies[b].motion == JointMotion::spherical)
      turn_columns(turned_back(state, model.layout.position[b], dt), model.layout.joint_state(model.layout.position[b]),
                   errors);
  for (Index i = 0; i < model.layout.positions; ++i)
    mix_columns(transition(model.positions[static_cast<std::size_t>(i)], dt, means), errors.rows(),
                model.layout.joint_state(i), errors);
}

void add_bias_walk(const FilterModel& model, double dt, MatrixXd& p) {
  for (Index s = 0; s < model.layout.sensors; ++s) {
    const Index first = model.layout.sensor_state(s);
    p.diagonal().segment<3>(first + SensorIndex::gyroscope_bias).array() += dt * model.bias_walk.rate;
    p.diagonal().segment<3>(first + SensorIndex::accelerometer_bias).array() += dt * model.bias_walk.force;
  }
}

void predict_covariance(const FilterModel& model, const ChainState& state, double dt, MatrixXd& p, ShownMeans means) {
  const Index n = p.rows(), fast = model.layout.fast;
  if (state.base == BaseMode::moving) {
    move_base(model, state, dt, p);
    add_base_noise(model, dt, p);
  } else {
    p.diagonal().head<3>().array() += dt * still_base_walk * still_base_walk;
  }
  for (std::size_t b = 1; b < model.bodies.size(); ++b)
    if (model.bodies[b].motion == JointMotion::spherical)
      turn_columns(turned_back(state, model.layout.position[b], dt), model.layout.joint_state(model.layout.position[b]),
                   p);
  for (Index i = 0; i < model.layout.positions; ++i)
    mix_columns(transition(model.positions[static_cast<std::size_t>(i)], dt, means), n, model.layout.joint_state(i), p);
  // The columns of the joints now hold P Fᵀ; rows follow by symmetry where the other index is no joint's.
  for (Index j = base_states; j < fast; ++j) {
    p.row(j).head(base_states) = p.col(j).head(base_states).transpose();
    p.row(j).tail(n - fast) = p.col(j).tail(n - fast).transpose();
  }
  for (std::size_t b = 1; b < model.bodies.size(); ++b)
    if (model.bodies[b].motion == JointMotion::spherical)
      turn_rows(turned_back(state, model.layout.position[b], dt), model.layout.joint_state(model.layout.position[b]),
                base_states, fast, p);
  for (Index i = 0; i < model.layout.positions; ++i) {
    const AccelerationProcess process = lively(model.positions[static_cast<std::size_t>(i)], state.liveliness[i]);
    const Index first = model.layout.joint_state(i);
    const Transition f = transition(process, dt, means);
    for (Index j = base_states; j < fast; ++j) {
      double* x = p.col(j).data() + first;
      x[0] += f.position_from_velocity * x[1] + f.position_from_acceleration * x[2];
      x[1] += f.velocity_from_acceleration * x[2];
      x[2] *= f.acceleration_decay;
    }
    p.block<3, 3>(first, first) += driven(process, dt, means);
  }
  add_bias_walk(model, dt, p);
}

}  // namespace kinfer::track
