// SPDX-License-Identifier: Apache-2.0
// The robot of paper 2 and the settings that its figures are reproduced with (docs/development/methods/paper2.md).
#pragma once

#include <array>

#include "kinfer/base/rng.hpp"
#include "kinfer/kinematics/parameters.hpp"

namespace kinfer::paper2 {

inline constexpr double millimetre = 1e-3;  // [m]

/// d6 of table 1 is 125 mm; tables 4 and 5 fit table 3 only with about 100 mm of target offset added (section 2.2.2).
inline constexpr double d6_printed = 125 * millimetre, d6_with_target = 225 * millimetre;

/// Table 1, with joint limits ±170, −130..40, −60..140, ±180, ±120, ±180° for the poses.
Chain er20(double d6);

/// The 24 parameters of table 2, all free, in the order of the tables: a, d, theta, alpha of each row.
ParameterSet table2_parameters(const Chain& robot);

/// One number for each of the 24, as the tables print them: a [mm], d [mm], theta [deg], alpha [deg], row by row.
using Table = std::array<double, 24>;
extern const Table table3, table4, table5, table6, table7;

/// The robot with the table's errors added.
Chain with_errors(const Chain& nominal, const Table& errors, double factor = 1.0);

/// The table's numbers as parameter errors (SI) in the order of table2_parameters, and back.
VectorXd errors_si(const Table& errors);
Table errors_as_printed(ConstVectorRef si);

/// Drawn evenly from the joint limits, tool above the floor (z > 0) and more than 350 mm from axis 1 (nominal robot).
MatrixXd drawn_joints(const Chain& nominal, int poses, Rng rng);

}  // namespace kinfer::paper2
