// SPDX-License-Identifier: Apache-2.0
// Converts a joint of the continuous-time fit to evidence: axis line in both sensor frames, standard deviations,
// unobservable directions, canonical DH.
#pragma once

#include "kinfer/estimate/continuous/model/chain_propagation.hpp"
#include "kinfer/identify/geometry/identified_chain.hpp"
#include "kinfer/identify/geometry/initial_joint.hpp"
#include "kinfer/identify/geometry/mean_revolute.hpp"

namespace kinfer::identify {

struct RefinedJoint {
  JointEstimate estimate;
  GeometryEstimate solution;   ///< geometry with its home at joint position `zero`, standard deviations of the DH rows
  std::vector<double> zero{};  ///< [rad] or [m] positions of the fit's bodies that are defined as 0
  std::optional<MeanRevolute> mean{};  ///< of a relaxed revolute joint
};

/// Sense of the joint position of a single body relative to the fit's, 1 or −1: that of a known machine, or else the
/// axis' largest coordinate in the parent is positive.
double axis_sense(const InsBody& body, const std::optional<PositiveAxis>& known = {});

/// `bodies`: one, or several in series. `zero` [rad] or [m]: their joint positions that are defined as 0. `covariance`:
/// of the bodies' unknowns, one after the other. `spherical_axes`: see JointGeometry. `known`: as of
/// axis_sense.
RefinedJoint refined_joint(EstimatedJointType type, std::span<const InsBody> bodies, std::span<const double> zero,
                           ConstMatrixRef covariance, const Mat3& spherical_axes = Mat3::Identity(),
                           const std::optional<PositiveAxis>& known = {});

}  // namespace kinfer::identify
