// SPDX-License-Identifier: Apache-2.0
// The scale matrices of gyroscopes and accelerometers as unknowns of a fit: sensor by sensor, the gyroscope's before
// the accelerometer's, each column by column.
#pragma once

#include <array>
#include <vector>

#include "kinfer/estimate/continuous/model/problem.hpp"

namespace kinfer::identify::scale_parameters {

inline constexpr Eigen::Index elements = 9;                      ///< of a matrix
inline constexpr Eigen::Index first_scale = 6;                   ///< among a sensor's errors (InsLayout)
inline constexpr Eigen::Index each = 2 * elements;               ///< of a sensor
inline constexpr std::array<Eigen::Index, 3> diagonal{0, 4, 8};  ///< of a matrix

/// Standard deviations of the prior, for all sensors; `factors`: of each, none: 1.
VectorXd scale_priors(const InsProblem& problem, const std::vector<InsScaleFactor>& factors);

/// Information of priors with these standard deviations, beside which all instruments of a kind may share a factor.
MatrixXd scale_information(const VectorXd& sd, const InsCommonScales& common);

VectorXd scale_values(const std::vector<InsErrors>& errors);

/// Indices of the scale parameters among the global parameters.
std::vector<Eigen::Index> indices_of_scales(const InsLayout& layout);

/// A small rotation of an instrument's axes about x, y and z: its antisymmetric matrices, column by column.
MatrixXd rotations();

/// A factor of all gyroscopes, or of all accelerometers: a column of all scale parameters.
VectorXd common_factor(std::size_t sensors, InsInstrument instrument = InsInstrument::gyroscope);

}  // namespace kinfer::identify::scale_parameters
