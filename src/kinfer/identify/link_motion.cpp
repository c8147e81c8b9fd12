#include "kinfer/identify/link_motion.hpp"

namespace kinfer {
namespace {

void turn(FrameState& state, int axis, double angle, double rate, double rate_change) {
  const Vec3 direction = state.rotation.col(axis);
  state.rate_change += rate_change * direction + rate * state.rate.cross(direction);
  state.rate += rate * direction;
  state.rotation = state.rotation * (axis == 0 ? rot_x(angle) : rot_z(angle));
}

void turn_by(FrameState& state, int axis, double constant, int signal, const SignalRow& row) {
  if (signal == DhLeaf::constant) return turn(state, axis, constant, 0.0, 0.0);
  const auto k = static_cast<std::size_t>(signal);
  turn(state, axis, constant + row.angle[k], row.rate[k], row.rate_change[k]);
}

}  // namespace

SignalRow signals_at(std::span<const JointSignal> signals, std::size_t row) {
  SignalRow values;
  for (const JointSignal& signal : signals) {
    values.angle.push_back(signal.angle[row]);
    values.rate.push_back(signal.rate[row]);
    values.rate_change.push_back(signal.rate_change[row]);
  }
  return values;
}

FrameState carried(FrameState state, std::span<const DhLeaf> leaves, const SignalRow& signals) {
  for (const DhLeaf& leaf : leaves) {
    turn_by(state, 2, leaf.theta, leaf.theta_signal, signals);
    const Vec3 step = leaf.d * state.rotation.col(2) + leaf.a * state.rotation.col(0);
    state.acceleration += state.rate_change.cross(step) + state.rate.cross(state.rate.cross(step));
    turn_by(state, 0, leaf.alpha, leaf.alpha_signal, signals);
  }
  return state;
}

std::vector<FrameState> carried(const std::vector<FrameState>& parent, std::span<const DhLeaf> leaves,
                                std::span<const JointSignal> signals) {
  std::vector<FrameState> states;
  states.reserve(parent.size());
  for (std::size_t row = 0; row < parent.size(); ++row)
    states.push_back(carried(parent[row], leaves, signals_at(signals, row)));
  return states;
}

std::vector<FrameState> measured_states(const SegmentMotion& segment) {
  std::vector<FrameState> states;
  for (std::size_t row = 0; row < segment.rotation.size(); ++row)
    states.push_back({segment.rotation[row], segment.rate[row], segment.rate_change[row], segment.acceleration[row]});
  return states;
}

}  // namespace kinfer
