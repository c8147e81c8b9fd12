// SPDX-License-Identifier: Apache-2.0
// The filter's state in the terms of the chain's joint positions.
#pragma once

#include "kinfer/evidence/tracking/track_state.hpp"
#include "kinfer/track/readout/tool_spread.hpp"

namespace kinfer::track {

/// Rates of the angles of Rx(q₁) Ry(q₂) Rz(q₃) by its angular velocity in the rotating frame.
Mat3 cardan_rates(const Vec3& q);

/// A state with vectors of their final lengths, everything unknown.
TrackState unknown_state(const TrackingModel& model);

/// Joints, base and tool, with their deviations; neither time nor alarms. Nothing is allocated.
void take_estimates(const TrackState& from, TrackState& to);

/// Positions, velocities and the base's attitude; angles are continuous with those that `to` holds. `covariance`: of
/// the filter, some rows older than `state`. Nothing is allocated.
void read_out(const TrackingModel& tracking, const FilterModel& model, const ChainState& state,
              const MatrixXd& covariance, TrackState& to);

}  // namespace kinfer::track
