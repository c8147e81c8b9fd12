// How far the unknowns that hold for good may be from the truth, with and without trust in the noise model.
//
// Model: C = (information + prior)⁻¹ with the band free (Schur complement). Sandwich (White 1982, with time blocks for
// the memory of model errors, Newey and West 1987): C (M + P) C with M the outer products of the gradients summed over
// blocks of some seconds, P the prior's information. Where the model is right, M + P estimates C⁻¹ and both agree.
#pragma once

#include "kinfer/estimate/ins_cost.hpp"

namespace kinfer {

struct InsCovariance {
  MatrixXd model;      ///< border x border
  VectorXd inflation;  ///< variance by the sandwich over that by the model, one a border unknown
};

class InsSystem;

/// Nothing where the recording leaves an unknown without any information. `block` [s] of the sandwich.
std::optional<InsCovariance> covariance_of(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                                           int threads, double block = 2.0);

/// The same of a system without damping, and without the sandwich: no inflation.
std::optional<InsCovariance> covariance_of(const InsSystem& system, double block = 2.0);
std::optional<InsCovariance> model_covariance(const InsSystem& system);

}  // namespace kinfer
