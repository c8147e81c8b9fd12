// How a frame moves that a product of DH leaves carries on a moving parent: accelerations by the analytic Jacobian and
// its derivative (paper 1, eqs. 24, 25), as a recursion over the leaves instead of symbols.
#pragma once

#include <span>
#include <vector>

#include "kinfer/identify/dh_leaf.hpp"
#include "kinfer/inertial/joint_signals.hpp"

namespace kinfer {

/// One frame at one time; vectors in the ground.
struct FrameState {
  Mat3 rotation = Mat3::Identity();  ///< ground_R_frame
  Vec3 rate = Vec3::Zero();          ///< [rad/s]
  Vec3 rate_change = Vec3::Zero();   ///< [rad/s²]
  Vec3 acceleration = Vec3::Zero();  ///< [m/s²] of the origin, gravity not included
};

/// Values of the signals at one row.
struct SignalRow {
  std::vector<double> angle, rate, rate_change;
};
SignalRow signals_at(std::span<const JointSignal> signals, std::size_t row);

/// The state behind the leaves. With J of eq. (24), the acceleration is J q'' + J' q' of eq. (25) on a parent at rest.
FrameState carried(FrameState state, std::span<const DhLeaf> leaves, const SignalRow& signals);

/// At every row.
std::vector<FrameState> carried(const std::vector<FrameState>& parent, std::span<const DhLeaf> leaves,
                                std::span<const JointSignal> signals);

/// The measured states of a segment.
std::vector<FrameState> measured_states(const SegmentMotion& segment);

}  // namespace kinfer
