// SPDX-License-Identifier: Apache-2.0
// Order of the error state of the filter on a chain. Fast states first, then what changes slowly, then what is only
// considered (Schmidt 1966: its uncertainty acts, but it is not estimated):
//
//   base     attitude θ (R ← R exp(θ)), ω, α in the base sensor's frame; velocity, acceleration in the world
//   joints   of each joint position q, q̇, q̈; of a spherical joint three rotations (Q ← Q exp(φ)) with their rates
//   sensors  b_g, b_a, S_g, S_a of each, the matrices row by row
//   unseen   what the identification could not see: starts of positions with unknown zeros, turns of limbs,
//            axes on the base, points on the base and on segments
//   geometry the free unknowns of each body, in the order of InsBody
#pragma once

#include "kinfer/estimate/continuous/model/chain_propagation.hpp"

namespace kinfer::track {

using Index = Eigen::Index;

inline constexpr Index base_states = 15, position_states = 3, sensor_states = 24, sensor_rows = 6;

struct BaseIndex {
  static constexpr Index attitude = 0, rate = 3, angular_acceleration = 6, velocity = 9, acceleration = 12;
};

/// Of a sensor's states, relative to its first.
struct SensorIndex {
  static constexpr Index gyroscope_bias = 0, accelerometer_bias = 3, gyroscope_scale = 6, accelerometer_scale = 15;
};

struct FilterLayout {
  Index positions = 0;       ///< joint positions of the filter: three for a spherical joint
  Index sensors = 0;         ///< their number
  Index fast = 0;            ///< states of base and joints
  Index first_unseen = 0;    ///< states of sensors end here
  Index first_point = 0;     ///< of those unseen: the points, which are considered until a base that moves shows them
  Index first_geometry = 0;  ///< states that are estimated end here
  Index size = 0;            ///< all
  std::vector<Index> position{};      ///< of each body: its first joint position; −1: none
  std::vector<Index> geometry{};      ///< of each body: its first geometry state, relative to first_geometry
  std::vector<Index> fast_end{};      ///< of each body: its measurements depend on fast states before this
  std::vector<Index> geometry_end{};  ///< likewise, relative to first_geometry

  Index joint_state(Index at) const { return base_states + position_states * at; }
  Index sensor_state(Index sensor) const { return fast + sensor_states * sensor; }
  Index unseen() const { return first_geometry - first_unseen; }
  Index rows() const { return sensor_rows * sensors; }
};

FilterLayout layout_of(const InsBodies& bodies, Index sensors, Index unseen_angles = 0, Index unseen_points = 0);

}  // namespace kinfer::track
