// SPDX-License-Identifier: Apache-2.0
// Causes by which the geometry of a machine can differ from that of its last identification, as rigid motions of what
// is expressed in a sensor's frame.
#pragma once

#include "kinfer/evidence/identification/chain_update.hpp"
#include "kinfer/identify/update/aligned_bodies.hpp"
#include "kinfer/identify/update/change_search.hpp"

namespace kinfer::identify {

struct ChainCause {
  ChainChangeKind kind{};
  std::string name{}, segment{}, alternative{};  ///< as in ChainChange
  int body = 0;                                  ///< of the sensor; of a joint the one that moved: its first or last
  bool in_parent = false;                        ///< of a joint: on its parent's segment
};

/// Every sensor; and every joint on each of its two segments, unless a sensor's move looks the same because it has no
/// other joint.
std::vector<ChainCause> possible_causes(const TrackingModel& model);

/// Number of a cause's rotations, and of all its components: a sensor's rotation vector [rad] and shift [m] in its old
/// frame; a joint's rotation across its axis and shift, in the axis' frame.
inline constexpr Eigen::Index sensor_rotations = 3, joint_rotations = 2;
Eigen::Index rotations_of(const ChainCause& cause);
Eigen::Index components_of(const ChainCause& cause);

/// The machine after a cause of this size. A tool stays where it is on its segment.
TrackingModel changed(const TrackingModel& model, const ChainCause& cause, ConstVectorRef size);

/// Derivatives of the parameters by the components of a cause, at no change: parameters x components.
MatrixXd effect_of(const TrackingModel& model, const ChainCause& cause,
                   const std::vector<TrackingParameter>& parameters);

}  // namespace kinfer::identify
