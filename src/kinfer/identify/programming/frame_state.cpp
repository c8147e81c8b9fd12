// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/programming/frame_state.hpp"

namespace kinfer::identify {
namespace {

void rotate(FrameState& state, int axis, double angle, double angular_velocity, double angular_acceleration) {
  const Vec3 direction = state.rotation.col(axis);
  state.angular_acceleration +=
      angular_acceleration * direction + angular_velocity * state.angular_velocity.cross(direction);
  state.angular_velocity += angular_velocity * direction;
  state.rotation = state.rotation * (axis == 0 ? rot_x(angle) : rot_z(angle));
}

void rotate_by(FrameState& state, int axis, double constant, int signal, const SignalRow& row) {
  if (signal == DhLeaf::constant) return rotate(state, axis, constant, 0.0, 0.0);
  const auto k = static_cast<std::size_t>(signal);
  rotate(state, axis, constant + row.angle[k], row.angular_velocity[k], row.angular_acceleration[k]);
}

}  // namespace

SignalRow signals_at(std::span<const JointSignal> signals, std::size_t row) {
  SignalRow values;
  for (const JointSignal& signal : signals) {
    values.angle.push_back(signal.angle[row]);
    values.angular_velocity.push_back(signal.angular_velocity[row]);
    values.angular_acceleration.push_back(signal.angular_acceleration[row]);
  }
  return values;
}

FrameState propagate(FrameState state, std::span<const DhLeaf> leaves, const SignalRow& signals) {
  for (const DhLeaf& leaf : leaves) {
    rotate_by(state, 2, leaf.theta, leaf.theta_signal, signals);
    const Vec3 step = leaf.d * state.rotation.col(2) + leaf.a * state.rotation.col(0);
    state.acceleration +=
        state.angular_acceleration.cross(step) + state.angular_velocity.cross(state.angular_velocity.cross(step));
    rotate_by(state, 0, leaf.alpha, leaf.alpha_signal, signals);
  }
  return state;
}

std::vector<FrameState> propagate(const std::vector<FrameState>& parent, std::span<const DhLeaf> leaves,
                                  std::span<const JointSignal> signals) {
  std::vector<FrameState> states;
  states.reserve(parent.size());
  for (std::size_t row = 0; row < parent.size(); ++row)
    states.push_back(propagate(parent[row], leaves, signals_at(signals, row)));
  return states;
}

std::vector<FrameState> measured_states(const SegmentMotion& segment) {
  std::vector<FrameState> states;
  for (std::size_t row = 0; row < segment.rotation.size(); ++row)
    states.push_back({segment.rotation[row], segment.angular_velocity[row], segment.angular_acceleration[row],
                      segment.acceleration[row]});
  return states;
}

}  // namespace kinfer::identify
