// What is known about the band before anything was said: channels are smooth beyond all shaking, and a constant that no
// signal tells stays where it started.
#pragma once

#include <functional>

#include "kinfer/estimate/ins_problem.hpp"

namespace kinfer {

/// One residual of the prior: Σ weights · the channel's coefficients in the interval, less what it is to be.
struct BandPriorTerm {
  Eigen::Index channel;
  Eigen::Matrix<double, spline_order, 1> weights;
  double value, sd;
};

/// Calls visit(term) for each residual that belongs to the interval.
void each_band_prior(const InsProblem& problem, const InsLayout& layout, ConstMatrixRef band, Eigen::Index interval,
                     const std::function<void(const BandPriorTerm&)>& visit);

}  // namespace kinfer
