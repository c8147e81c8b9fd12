// SPDX-License-Identifier: Apache-2.0
// What one pass of a tracker over a recording, forward or backward, knows at one row, and how two of them combine.
#pragma once

#include "kinfer/evidence/tracking/track_state.hpp"
#include "kinfer/evidence/tracking/tracking_model.hpp"

namespace kinfer::track {

/// A standard deviation, and the part of it that forward and backward pass have in common.
struct SharedSd {
  double sd = 0.0, shared = 0.0;
};

struct PassState {
  bool started = false;
  VectorXd q, qd, sd_q, sd_qd, shared_q;  ///< as in TrackState; shared_q: the common part of sd_q
  std::vector<JointStatus> joints{};
  Quat world_q_base = Quat::Identity();
  Vec3 sd_base = Vec3::Zero(), shared_base = Vec3::Zero();                    ///< [rad]
  Vec3 sd_tool_position = Vec3::Zero(), shared_tool_position = Vec3::Zero();  ///< [m]
  Vec3 sd_tool_rotation = Vec3::Zero(), shared_tool_rotation = Vec3::Zero();  ///< [rad]
};

/// Share of the second one in the best mean of two, and the mean's standard deviation. With e = e_own + e_shared, the
/// shared errors fully correlated, the variance of (1 − w) a + w b is least for
///   w = (v_a + s_a (s_a − s_b)) / (v_a + v_b + (s_a − s_b)²),  v: variance of the own part, s: shared sd
struct Blend {
  double share = 0.0, sd = 0.0;
};
Blend blend(SharedSd a, SharedSd b);

/// The mean of both passes at one row, joint by joint, put into `to`, which holds the state of the forward pass.
/// `backward` has been turned round: its velocities are those of the machine. A joint position that counts from the
/// start in one pass only is that of the other pass; where it does in both, the forward pass stays: the backward one
/// has seen nothing more of it. The base's heading is that of the forward pass.
void combine(const TrackingModel& model, const PassState& forward, const PassState& backward, TrackState& to);

}  // namespace kinfer::track
