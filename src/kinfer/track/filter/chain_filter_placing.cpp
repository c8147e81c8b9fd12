// SPDX-License-Identifier: Apache-2.0
// Where a filter on a chain is told that the chain stands, and what of that is known.
#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/square.hpp"
#include "kinfer/track/filter/chain_filter.hpp"
#include "kinfer/track/model/thresholds.hpp"

namespace kinfer::track {

void ChainFilter::start(const ChainState& state, ConstMatrixRef fast) {
  const FilterLayout& layout = model_->layout;
  KINFER_EXPECT(fast.rows() == layout.fast && fast.cols() == layout.fast);
  ChainState before = std::move(state_);
  state_ = state;
  state_.sensors = std::move(before.sensors);
  state_.start = std::move(before.start);
  state_.turned = std::move(before.turned);
  state_.tilted = std::move(before.tilted);
  state_.moved = std::move(before.moved);
  if (last_update_) let_biases_walk(state.time - *last_update_);
  placed_ = state.time;
  limb_turns_.begin();
  p_.leftCols(layout.fast).setZero();
  p_.topRows(layout.fast).setZero();
  p_.topLeftCorner(layout.fast, layout.fast) = fast;
  headings_.reset();
  mean_rates_.reset();
  constant_faults_.by_fault().leftCols(layout.fast).setZero();
}

/// Over a gap without predictions. A first-order Gauss-Markov process differs from itself by 2σ² at most.
void ChainFilter::let_biases_walk(double gap) {
  const double time = std::clamp(gap, 0.0, model_->instability_time);
  add_bias_walk(*model_, time, p_);
  widen_bias_distance(time);
}

/// By what biases may have walked.
void ChainFilter::widen_bias_distance(double dt) {
  for (Index s = 0; s < model_->layout.sensors; ++s) {
    bias_variance_.segment<3>(sensor_rows * s).array() += dt * model_->bias_walk.rate;
    bias_variance_.segment<3>(sensor_rows * s + 3).array() += dt * model_->bias_walk.force;
  }
}

void ChainFilter::widen(Index first, ConstMatrixRef covariance) {
  p_.block(first, first, covariance.rows(), covariance.cols()) += covariance;
}

/// It counted from the start and will be shown by motion.
void ChainFilter::free_heading(std::size_t body, double sd) {
  headings_.free(body, sd, p_);
  mirror();
}

/// The state of the zero of a revolute joint's positions; −1: it is not considered.
Index ChainFilter::zero_state(Index position) const {
  const auto at = std::ranges::find(model_->layout.position, position);
  const auto b = static_cast<std::size_t>(at - model_->layout.position.begin());
  if (b >= model_->bodies.size()) return -1;
  const InsBody& body = model_->bodies[b];
  if (body.motion != JointMotion::revolute || !body.free_child_rotation[2]) return -1;
  return model_->layout.first_geometry + model_->layout.geometry[b] + body.turns() - 1;
}

/// Nothing is known of it, nor what a fault makes of it.
void ChainFilter::forget(Index state) {
  p_.row(state).setZero();
  p_.col(state).setZero();
  MatrixXd& by_fault = constant_faults_.by_fault();
  if (state < by_fault.cols()) by_fault.col(state).setZero();
}

void ChainFilter::place(Index position, double value, double sd) {
  const Index at = model_->layout.joint_state(position), zero = zero_state(position);
  forget(at);
  placed_ = state_.time;
  if (zero >= 0 && p_(zero, zero) <= 0.0)
    p_(zero, zero) = model_->parameters(zero - model_->layout.fast, zero - model_->layout.fast);
  state_.joints[position_states * position] = value;
  p_(at, at) = sd * sd;
}

void ChainFilter::count_from_start(Index position, std::optional<double> stated, double sd) {
  const UnknownZero& zero = *model_->unknown_zero(position);
  const Index at = model_->layout.joint_state(position);
  p_.row(zero.state) = p_.row(at);
  p_.col(zero.state) = p_.col(at);
  p_(zero.state, zero.state) = p_(at, at) + (stated ? sd * sd : 0.0);
  constant_faults_.by_fault().col(zero.state) = constant_faults_.by_fault().col(at);
  if (stated) state_.start[position] = state_.joints[position_states * position] - *stated;
  counts_from_start_ = true;
}

void ChainFilter::turn_start(Index position, double turn, double sd, double lost_sd) {
  const UnknownZero& zero = *model_->unknown_zero(position);
  const Index at = model_->layout.joint_state(position);
  state_.joints[position_states * position] += turn;
  state_.start[position] += turn;
  p_(at, at) += sd * sd;
  p_(zero.state, zero.state) += sd * sd + lost_sd * lost_sd;
  p_(at, zero.state) += sd * sd;
  p_(zero.state, at) += sd * sd;
  placed_ = state_.time;
}

void ChainFilter::place_axis(std::size_t body, const Vec3& from, const Vec3& to) {
  const Index first = model_->unknown_axis(body)->state;
  const Mat3& as_modelled = model_->bodies[body].parent_R_axis;
  state_.tilted[body] *= as_modelled * rotation_between(to, from).toRotationMatrix() * as_modelled.transpose();
  for (Index state = first; state < first + 2; ++state) {
    forget(state);
    const Index slow = state - model_->layout.fast;
    p_(state, state) = model_->parameters(slow, slow);
  }
}

void ChainFilter::keep_gravity(std::size_t body, double turn) {
  if (!model_->unknown_axis(body)) return;
  const Vec3 up = state_.world_R_base.row(2), from = parent_side(*model_, state_, body).parent_R_axis.transpose() * up;
  place_axis(body, from, rot_z(turn) * from);
}

void ChainFilter::turn_limb(std::size_t body, double turn, double sd) {
  const UnknownTurn& limb = *model_->unknown_turn(body);
  forget(limb.state);
  state_.turned[static_cast<Index>(body)] += turn;
  p_(limb.state, limb.state) = sd * sd;
  LimbTurns::free_first_joint(*model_, limb, square(tilt_of(limb)), p_);
  limb_turns_.know(body, true);
  placed_ = state_.time;
}

void ChainFilter::forget_turn(std::size_t body) {
  forget(model_->unknown_turn(body)->state);
  limb_turns_.know(body, false);
}

void ChainFilter::suppose(Index position, double value, double sd) {
  const Index at = model_->layout.joint_state(position), estimated = this->estimated();
  const double variance = p_(at, at), change = sd * sd - variance;
  VectorXd& share = column_;
  share = p_.col(at) / variance;
  error_.setZero();
  error_.head(estimated) = (value - state_.joints[position_states * position]) * share.head(estimated);
  retract(*model_, error_, state_);
  MatrixXd& by_fault = constant_faults_.by_fault();
  for (Index j = 0; j < estimated; ++j)
    if (j != at) by_fault.col(j) -= share[j] * by_fault.col(at);
  by_fault.col(at).setZero();
  for (Index j = 0; j < estimated; ++j)
    for (Index i = j; i < p_.rows(); ++i) p_(i, j) += change * share[i] * share[j];
  mirror();
}

void ChainFilter::suppose_velocity(Index position, std::size_t sensor, const Vec3& rate) {
  evaluator_.evaluate(*model_, state_);
  const ChainMeasurement& m = evaluator_.result();
  const Index row = sensor_rows * static_cast<Index>(sensor), at = model_->layout.joint_state(position) + 1;
  const Vec3 by_velocity = m.by_fast.block<3, 1>(row, at), missing = rate - m.value.segment<3>(row);
  state_.joints[at - base_states] += by_velocity.dot(missing) / by_velocity.squaredNorm();
}

void ChainFilter::count_from_here(Index position) {
  const UnknownZero* unknown = model_->unknown_zero(position);
  if (state_.base == BaseMode::moving && !unknown)
    return place(position, state_.joints[position_states * position], 0.0);
  placed_ = state_.time;
  forget(model_->layout.joint_state(position));
  if (unknown) forget(unknown->state);
  if (const Index zero = zero_state(position); zero >= 0) forget(zero);
}

}  // namespace kinfer::track
