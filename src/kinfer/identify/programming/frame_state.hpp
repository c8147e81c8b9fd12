// SPDX-License-Identifier: Apache-2.0
// Motion of a frame that a product of DH leaves attaches to a moving parent: accelerations by the analytic Jacobian and
// its derivative (paper 1, eqs. 24, 25), as a recursion over the leaves instead of symbolically.
#pragma once

#include <span>
#include <vector>

#include "kinfer/identify/programming/dh_leaf.hpp"
#include "kinfer/inertial/joint_signals.hpp"

namespace kinfer::identify {

/// State of one frame at one time; vectors in the world frame.
struct FrameState {
  Mat3 rotation = Mat3::Identity();          ///< world_R_frame
  Vec3 angular_velocity = Vec3::Zero();      ///< [rad/s]
  Vec3 angular_acceleration = Vec3::Zero();  ///< [rad/s²]
  Vec3 acceleration = Vec3::Zero();          ///< [m/s²] of the origin, gravity not included
};

/// Values of the joint signals at one row.
struct SignalRow {
  std::vector<double> angle, angular_velocity, angular_acceleration;
};
SignalRow signals_at(std::span<const JointSignal> signals, std::size_t row);

/// The state of the frame after the leaves. With J of eq. (24), the acceleration is J q'' + J' q' of eq. (25) on a
/// parent at rest.
FrameState propagate(FrameState state, std::span<const DhLeaf> leaves, const SignalRow& signals);

/// The same at every row.
std::vector<FrameState> propagate(const std::vector<FrameState>& parent, std::span<const DhLeaf> leaves,
                                  std::span<const JointSignal> signals);

/// The measured states of a segment.
std::vector<FrameState> measured_states(const SegmentMotion& segment);

}  // namespace kinfer::identify
