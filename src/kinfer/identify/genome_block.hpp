// The kernel that all searches of a link evaluate with: the state of a frame carried through DH leaves, 64 rows of the
// recording at a time, in plain loops over arrays that a compiler turns into vector instructions.
#pragma once

#include <array>
#include <vector>

#include "kinfer/identify/link_motion.hpp"

namespace kinfer {

constexpr std::size_t block_width = 64;  // rows of a block: its state of 18 numbers a row then fits the first cache
using Lane = std::array<double, block_width>;
using Lanes3 = std::array<Lane, 3>;

/// States of a block in the ground; axes[k] is column k of ground_R_frame.
struct FrameLanes {
  std::array<Lanes3, 3> axes;
  Lanes3 rate, rate_change, acceleration;
};

/// Sine and cosine of a signal, once for all evaluations, and its derivatives.
struct SignalLanes {
  Lane sine, cosine, rate, rate_change;
};

/// Turns the frame about its axis `k` (0: x, 2: z) by a signal; u and v are the axes that turn, u towards v.
void turn_by_signal(FrameLanes& s, std::size_t k, std::size_t u, std::size_t v, const SignalLanes& q);

/// Turns axis u towards v by a constant angle [rad].
void turn_by_constant(FrameLanes& s, std::size_t u, std::size_t v, double angle);

/// Moves the origin by d along z and a along x: p'' += ω' × r + ω × (ω × r).
void step(FrameLanes& s, double d, double a);

/// What a metre along axis k of the frame adds to its acceleration.
void lever_column(const FrameLanes& s, std::size_t k, Lanes3& column);

/// Rows of a link: the parent's states, the signals, and what the child measured.
struct LinkBlock {
  FrameLanes parent;
  std::vector<SignalLanes> signals;
  Lanes3 acceleration;         // measured
  std::array<Lanes3, 3> axes;  // columns of the measured rotation
  Lanes3 angles;               // measured roll, pitch, yaw
  Lane weight;                 // 1; 0 for lanes that no row fills

  /// Angles of one leaf: theta, or alpha.
  void turn_theta(FrameLanes& s, const DhLeaf& leaf) const;
  void turn_alpha(FrameLanes& s, const DhLeaf& leaf) const;
  void carry(FrameLanes& s, std::span<const DhLeaf> leaves) const;
  FrameLanes carried(std::span<const DhLeaf> leaves) const;  ///< from the parent

  double acceleration_square(const FrameLanes& s) const;
  double chord_square(const FrameLanes& s) const;  ///< half the squared Frobenius norm of the rotations' difference
  double euler_square(const FrameLanes& s) const;

  void fill(std::size_t lane, const FrameState& p, const FrameState& c, const SignalRow& q);
};

/// Every block spans the whole recording, so that the first one is a fair sample of it. `rows` at least 1.
std::vector<LinkBlock> link_blocks(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                                   std::span<const JointSignal> signals, const std::vector<std::size_t>& rows);

}  // namespace kinfer
