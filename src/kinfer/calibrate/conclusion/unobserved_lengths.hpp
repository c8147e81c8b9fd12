// SPDX-License-Identifier: Apache-2.0
// Lengths that no measurement of a calibration determines.
//
// Contacts, planes, tilts and directions stay the same where robot, base and fixtures are all larger by the same
// factor: without a measured length the tolerances alone decide the size. How far it may be off follows from the
// covariance: a change d_i of the tool point at pose i is, in the least-squares sense, a change of size by s = sum (d_i
// - mean d) . (p_i - mean p) / sum |p_i - mean p|^2, which no motion of the base changes.
#pragma once

#include <optional>

#include "kinfer/calibrate/problem/task.hpp"
#include "kinfer/evidence/calibration/calibration_facts.hpp"
#include "kinfer/evidence/calibration/estimate.hpp"

namespace kinfer::calibrate {

/// Standard deviation [1] of the size of the calibrated robot over the poses of `data`, from the covariance of its
/// parameters.
double relative_size_sd(const Estimate& estimate, const PoseSet& data);

/// Nothing where a length was measured: by an instrument, by a known distance of two sockets, or by the readings of a
/// prismatic joint that moved far enough.
std::optional<UnobservedLengths> find_unobserved_lengths(const CalibrationTask& task, const Estimate& estimate);

}  // namespace kinfer::calibrate
