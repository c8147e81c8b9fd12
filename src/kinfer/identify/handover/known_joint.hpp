// SPDX-License-Identifier: Apache-2.0
// A joint of a tracking model in the terms of the continuous-time fit: where another fit may begin.
#pragma once

#include "kinfer/estimate/continuous/model/chain_propagation.hpp"
#include "kinfer/evidence/tracking/tracking_model.hpp"

namespace kinfer::identify {

/// Indices of a joint's bodies, in series.
std::vector<std::size_t> bodies_of_joint(const TrackingModel& model, std::size_t joint);

/// The rotation about a body's own axis of revolution: where its joint positions count from.
bool is_zero_of_revolute(const TrackingModel& model, const TrackingParameter& parameter);

struct KnownJoint {
  std::string parent, child;  ///< sensors
  EstimatedJointType type = EstimatedJointType::revolute;
  std::vector<InsBody> bodies;             ///< in series, without parent and sensor
  std::vector<double> zero;                ///< as for refined_joint
  Mat3 spherical_axes = Mat3::Identity();  ///< as for refined_joint
  std::vector<Eigen::Index> parameters{};  ///< rows of the model's covariance: the bodies' unknowns in their order
};

/// Every joint of the model, in its order.
std::vector<KnownJoint> known_joints(const TrackingModel& model);

}  // namespace kinfer::identify
