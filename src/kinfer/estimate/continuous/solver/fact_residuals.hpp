// SPDX-License-Identifier: Apache-2.0
// Residuals of external measurements on a machine (facts: touches, tapes, surveyed points, azimuths) and of its loop
// closures, with their derivatives with respect to the unknowns of the continuous-time fit.
#pragma once

#include "kinfer/estimate/continuous/solver/fact_rows.hpp"

namespace kinfer {

/// Of all facts, in their order: touches, tapes, surveyed points, azimuths, closures.
std::vector<InsFactRows> fact_rows(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x);

/// Sum of the squared residuals.
double fact_cost(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x);

/// Initial values of the facts' own unknowns, as predicted by the rest of `x`.
InsFactUnknowns initial_fact_unknowns(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x);

/// Position of a point of the machine in the root's frame at a time [m].
Vec3 point_position(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, const InsPoint& point,
                    double time);

}  // namespace kinfer
