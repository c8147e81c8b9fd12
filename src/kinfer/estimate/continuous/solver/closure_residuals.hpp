// SPDX-License-Identifier: Apache-2.0
// Residuals of a revolute joint that closes a kinematic loop: at each of its times a line of one body coincides with a
// line of another, by point and by direction. Of the machine's forward kinematics only: no measurement is involved.
//
//   [p_second − p_first] / point_sd,   [x_first · z_second, y_first · z_second] / axis_sd
//
// with the points p and the axes x, y, z of the joint's frame on either body, all in the root's frame.
#pragma once

#include "kinfer/estimate/continuous/solver/fact_rows.hpp"

namespace kinfer {

/// Appends the rows of closure `index` at each of its times: five each.
void append_closure_rows(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, std::size_t index,
                         std::vector<InsFactRows>& rows);

/// Sum of the squared residuals of closure `index`.
double closure_cost(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, std::size_t index);

}  // namespace kinfer
