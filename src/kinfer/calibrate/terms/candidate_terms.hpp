// SPDX-License-Identifier: Apache-2.0
// All non-geometric terms that the data could tell, in one chain, and the models that consist of some of them.
#pragma once

#include <vector>

#include "kinfer/calibrate/problem/task.hpp"
#include "kinfer/calibrate/terms/model_terms.hpp"
#include "kinfer/calibrate/terms/relevance.hpp"

namespace kinfer::calibrate {

/// A number that a term adds, with the prior of its term.
struct CandidateParameter {
  Term term;
  Parameter parameter;
};

/// The chain of a fit with the structure of terms added (harmonics, couplings, masses), values zero.
struct CandidateTerms {
  Chain chain;
  std::vector<CandidateParameter> parameters;
  std::vector<SelectionStep> steps;  ///< one per term: what it adds, or why it cannot be tested
};

/// Of every term but spectral lines, which are found in the residuals of a fit with all others.
CandidateTerms make_candidates(const Estimate& geometry, const CalibrationTask& task, const PoseSet& rows);

void add_spectral_lines(CandidateTerms& candidates, const std::vector<SpectralLine>& lines, const CalibrationTask& task,
                        const PoseSet& rows);

/// Removes harmonics that a series of their joint has already.
void remove_parts_of_series(std::vector<Parameter>& parameters, const Chain& chain);

/// The set with further parameters, also beside a joint prior of those that it has.
ParameterSet with_parameters(ParameterSet set, const std::vector<Parameter>& more);

/// A model to be fitted: geometry and some of the candidates.
struct TermModel {
  Chain chain;
  ParameterSet parameters;
  std::vector<CandidateParameter> terms;
};

/// Geometry and all candidates with the priors of their terms.
TermModel model_of_all(const CandidateTerms& candidates, const ParameterSet& geometry);

/// Geometry and the candidates of groups with a factor above 0, whose prior is multiplied by it; `chain` has no
/// structure of others. `fitted`: a fit of all candidates.
TermModel model_of_relevant(const CandidateTerms& candidates, const Estimate& geometry, const Estimate& fitted,
                            const std::vector<RelevanceGroup>& groups, const std::vector<double>& factors);

/// term x joint, and each spectral line by itself. Members count the candidates.
std::vector<RelevanceGroup> relevance_groups(const CandidateTerms& candidates);

/// Indices of the candidates among the free parameters of a fit of all of them.
std::vector<int> free_indices(const Estimate& fit, const std::vector<CandidateParameter>& parameters);

/// Of the free parameters of a fit at `indices`; all others are marginalised.
LinearisedTerms linearise_terms(const Estimate& fit, std::span<const int> indices);

/// From the marginal posterior N(offset, covariance) of parameters, in units of their prior N(0, I).
LinearisedTerms without_own_prior(const MatrixXd& covariance, const VectorXd& offset);

}  // namespace kinfer::calibrate
