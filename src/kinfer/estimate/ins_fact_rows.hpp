// Residuals of the facts about a machine, with their derivatives by the unknowns of the continuous-time fit.
#pragma once

#include "kinfer/estimate/ins_problem.hpp"

namespace kinfer {

/// The rows of one fact at one time, in units of its standard deviation.
struct InsFactRows {
  Eigen::Index interval = 0;
  VectorXd left;        ///< what is asked for minus what is predicted
  MatrixXd derivative;  ///< of the prediction: rows x (order · channels + border); column i · channels + channel is the
                        ///< channel's i-th coefficient in the interval
};

/// Of all facts, in their order: touches, tapes, surveyed points.
std::vector<InsFactRows> fact_rows(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x);

/// Sum of the squared residuals.
double fact_cost(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x);

/// The facts' own unknowns as the rest of `x` predicts them.
InsFactUnknowns started_facts(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x);

/// Position of a point of the machine in the root's frame at a time [m].
Vec3 placed_point(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, const InsPoint& point,
                  double time);

}  // namespace kinfer
