// SPDX-License-Identifier: Apache-2.0
// Evaluation kernel of all link searches: propagates the state of a frame through DH leaves, 64 rows of the recording
// at a time, in plain loops over arrays that the compiler vectorises.
#pragma once

#include <array>
#include <vector>

#include "kinfer/identify/programming/frame_state.hpp"

namespace kinfer::identify {

constexpr std::size_t block_width = 64;  // rows of a block: its state, 18 numbers a row, then fits the L1 cache
using Lane = std::array<double, block_width>;
using Lanes3 = std::array<Lane, 3>;

/// States of a block in the world frame; axes[k] is column k of world_R_frame.
struct FrameLanes {
  std::array<Lanes3, 3> axes;
  Lanes3 angular_velocity, angular_acceleration, acceleration;
};

/// Sine and cosine of a signal, computed once for all evaluations, and its time derivatives.
struct SignalLanes {
  Lane sine, cosine, angular_velocity, angular_acceleration;
};

/// Rotates the frame about its axis `k` (0: x, 2: z) by a signal; u and v are the other two axes, u rotates towards v.
void rotate_by_signal(FrameLanes& s, std::size_t k, std::size_t u, std::size_t v, const SignalLanes& q);

/// Rotates axis u towards v by a constant angle [rad].
void rotate_by_constant(FrameLanes& s, std::size_t u, std::size_t v, double angle);

/// Translates the origin by d along z and a along x: p'' += ω' × r + ω × (ω × r).
void translate_origin(FrameLanes& s, double d, double a);

/// Acceleration per metre of lever arm along axis k of the frame [1/s²].
void lever_arm_column(const FrameLanes& s, std::size_t k, Lanes3& column);

/// A block of a link's rows: the parent's states, the signals, and the child's measurements.
struct LinkBlock {
  FrameLanes parent;
  std::vector<SignalLanes> signals;
  Lanes3 acceleration;         // measured
  std::array<Lanes3, 3> axes;  // columns of the measured rotation
  Lanes3 angles;               // measured roll, pitch, yaw
  Lane weight;                 // 1; 0 for unused lanes

  /// Apply the rotation by theta or alpha of one leaf.
  void rotate_theta(FrameLanes& s, const DhLeaf& leaf) const;
  void rotate_alpha(FrameLanes& s, const DhLeaf& leaf) const;
  void apply_leaves(FrameLanes& s, std::span<const DhLeaf> leaves) const;
  FrameLanes propagate(std::span<const DhLeaf> leaves) const;  ///< from the parent's state

  double squared_acceleration_error(const FrameLanes& s) const;
  double squared_chord(const FrameLanes& s) const;  ///< half the squared Frobenius norm of the rotations' difference
  double squared_euler_error(const FrameLanes& s) const;

  void set_row(std::size_t lane, const FrameState& p, const FrameState& c, const SignalRow& q);
};

/// Every block spans the whole recording, so that the first one is a representative sample. `rows`: at least 1.
std::vector<LinkBlock> make_link_blocks(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                                        std::span<const JointSignal> signals, const std::vector<std::size_t>& rows);

}  // namespace kinfer::identify
