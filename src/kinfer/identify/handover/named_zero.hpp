// SPDX-License-Identifier: Apache-2.0
// Zeros of joint positions that the user names: where the recording begins is nobody's zero.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/identify/handover/parameter_covariance.hpp"
#include "kinfer/kinematics/joint_type.hpp"

namespace kinfer::identify {

/// The joint had this position at that time of the recording.
struct NamedZero {
  std::string joint{};    ///< "ins1-ins2", "ins1-ins2 2" of a universal joint, or the child's sensor alone
  double position = 0.0;  ///< [rad] or [m]
  elementary::Motion motion = elementary::Motion::rotation;  ///< what the position is of
  double at = 0.0;                                           ///< [s]
};

/// The statement about position `index` of a joint; null if there is none. `names`: of the recording's sensors.
const NamedZero* named_zero(std::span<const NamedZero> zeros, const JointBodies& joint, std::size_t index,
                            const std::vector<std::string>& names);

/// An error for a joint that is unknown, has no single zero or another motion, and for a time outside the recording.
Result<void> check_zeros(std::span<const NamedZero> zeros, std::span<const JointBodies> joints,
                         const std::vector<std::string>& names, const SplineGrid& grid);

}  // namespace kinfer::identify
