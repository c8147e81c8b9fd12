// SPDX-License-Identifier: Apache-2.0
// Two tracking models of one machine in the same terms. The axes of a joint's frames, the place along its axis and the
// zero of its positions are free choices; here one model takes those of the other, so that what is left is difference.
#pragma once

#include <functional>

#include "kinfer/evidence/tracking/tracking_model.hpp"

namespace kinfer::identify {

using TrackingBodies = std::vector<TrackingBody>;

/// The bodies of `model` by the choices of `reference`, its zeros excepted: for the same structure, in the same order.
TrackingBodies aligned(const TrackingModel& model, const TrackingModel& reference);

/// The same with the covariance in these terms.
TrackingModel aligned_model(const TrackingModel& model, const TrackingModel& reference);

/// The model after a change of its bodies, which their errors take part in. `change`: of a model without covariance.
using BodiesChange = std::function<TrackingBodies(const TrackingModel&)>;
TrackingModel transported(const TrackingModel& model, const BodiesChange& change);

/// The model without its covariance, which is large.
TrackingModel without_covariance(const TrackingModel& model);

/// Change of one body: rotations of A and B about their own axes, of p and c [m]; in the order of
/// TrackingParameterKind, three each.
using BodyDifference = Eigen::Matrix<double, 12, 1>;
BodyDifference difference(const TrackingBody& from, const TrackingBody& to);

/// Of the geometry among `parameters`: `to` less `from`, both aligned with the same reference.
VectorXd difference(const TrackingBodies& from, const TrackingBodies& to,
                    const std::vector<TrackingParameter>& parameters);

/// The body after an increment of its parameters.
TrackingBody retracted(const TrackingBody& body, const BodyDifference& step);

/// Joint positions that `model` counts from its own zeros, less those counted from the zeros of `reference`: of each
/// position; 0 of spherical joints.
VectorXd zero_offsets(const TrackingModel& model, const TrackingModel& reference);

}  // namespace kinfer::identify
