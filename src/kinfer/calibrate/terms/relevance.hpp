// SPDX-License-Identifier: Apache-2.0
// Automatic relevance determination: how large the parameters of each group of model terms are, by the marginal
// likelihood of the data (MacKay 1992, "Bayesian interpolation"; Tipping 2001, "Sparse Bayesian learning").
//
// About the optimum of a fit the measurements are linear in the parameters, so all that they say of the m term
// parameters u (in units of their stated priors, every other parameter marginalised under its own prior) is
//   log p(data | u) = const − ½ uᵀ A u + bᵀ u.
// With u_g ~ N(0, f_g² I) for each group g, S and q the information and image of the group given all others,
//   log p(data | f_g) − log p(data | f_g = 0) = ½ Σ_k [ f² q_k²/(1 + f² s_k) − log(1 + f² s_k) ]      (eigenvalues s_k)
// is integrated over f under a half-Cauchy prior of scale 1 (Gelman 2006), which charges each group for its freedom.
// Sizes above the stated prior are left out: they win little among the poses and ruin every pose beyond them.
#pragma once

#include <span>
#include <vector>

#include "kinfer/linalg/types.hpp"

namespace kinfer::calibrate {

/// What the measurements say of some parameters, in units of their prior standard deviations about their prior means.
struct LinearisedTerms {
  MatrixXd information;  ///< A, m x m, without the priors of these parameters
  VectorXd image;        ///< b, m
};

/// Parameters with one variance.
struct RelevanceGroup {
  std::vector<int> members;  ///< indices into LinearisedTerms
  int family = 0;            ///< groups of one term are expected to be of one size
  bool own_size = false;     ///< of groups that have nothing in common with their family: spectral lines
};

struct GroupRelevance {
  double factor = 0.0;             ///< f_g, standard deviation in units of the stated prior; 0: left out
  double log_evidence_gain = 0.0;  ///< of the group, given the others; negative: the data speak against it
};

/// The same at one of several noise levels, where the noise is not known.
struct TermsAtNoise {
  LinearisedTerms terms;
  double log_likelihood = 0.0;  ///< log p(data, this noise level | all terms 0), but for a constant
};

/// The factors that maximise the marginal likelihood, one per group; over all noise levels together. Of a term that the
/// data support, each joint's is the root of its expected square, over whether the joint has the term or not.
std::vector<GroupRelevance> weigh_groups(const std::vector<TermsAtNoise>& levels,
                                         const std::vector<RelevanceGroup>& groups);

/// log p(data | factors) − log p(data | all factors 0) at one noise level, without the prior of the factors. One factor
/// per parameter.
double log_evidence(const LinearisedTerms& terms, const VectorXd& factors);

/// The same over all noise levels, one factor per group.
double log_evidence(const std::vector<TermsAtNoise>& levels, const std::vector<RelevanceGroup>& groups,
                    std::span<const double> factors);

/// Gain of several groups together, given the others.
double joint_log_evidence_gain(const std::vector<TermsAtNoise>& levels, const std::vector<RelevanceGroup>& groups,
                               std::vector<double> factors, int family);

/// What the measurements say at the noise level that is most likely without any term.
const LinearisedTerms& without_terms(const std::vector<TermsAtNoise>& levels);

}  // namespace kinfer::calibrate
