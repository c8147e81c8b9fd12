// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/selection/term_steps.hpp"

#include <algorithm>
#include <limits>

#include "kinfer/calibrate/terms/ablation.hpp"

namespace kinfer::calibrate {
namespace {

bool is_later(Term other, Term term) {
  return static_cast<int>(other) > static_cast<int>(term);
}

void take_proof(SelectionStep& step, const TermProof& proof) {
  step.interpolation = proof.interpolation, step.extrapolation = proof.extrapolation;
}

/// Gain of the best group of a term without support; not_excited where the data know none of its numbers better than
/// their priors do.
void describe_unsupported(SelectionStep& step, const WeighedTerms& terms, int family) {
  bool excited = false;
  step.log_evidence_gain = -std::numeric_limits<double>::max();
  for (std::size_t g = 0; g < terms.groups.size(); ++g) {
    if (terms.groups[g].family != family) continue;
    step.log_evidence_gain = std::max(step.log_evidence_gain, terms.relevance[g].log_evidence_gain);
    for (const int k : terms.groups[g].members) excited |= without_terms(terms.linearised).information(k, k) > 1.0;
  }
  if (!excited) step.decision = Decision::not_excited;
}

/// Of a term that the model has: its numbers, what they move the tool by, and the errors of the terms up to it.
WeighedStep accepted_step(SelectionStep step, const WeighedTerms& terms, const SelectionData& data) {
  const Term term = *step.term;
  const ProvedModel& relevant = terms.relevant;
  step.decision = Decision::accepted;
  for (const TermProof& proof : terms.accepted)
    if (proof.term == term) take_proof(step, proof);
  for (const CandidateParameter& c : terms.candidates.parameters)
    if (c.term == term) count_determined(step, c.parameter.name, relevant.fit);
  std::vector<CandidateParameter> own, later;
  for (const CandidateParameter& c : relevant.model.terms) {
    if (c.term == term) own.push_back(c);
    if (is_later(c.term, term)) later.push_back(c);
  }
  const Chain up_to_it =
      later.empty() ? relevant.fit.chain : chain_without(relevant.fit, free_indices(relevant.fit, later));
  step.train = training_statistics(up_to_it, relevant.fit.outliers, data.rows);
  step.contribution = displacement(relevant.fit.chain, own, data.rows);
  const auto remove = [&](Term other) { return is_later(other, term); };
  return {step,
          errors_without(relevant.interpolation, relevant.model.terms, remove, data.rows, data.splits, data.threads)};
}

WeighedStep step_of(SelectionStep step, const WeighedTerms& terms, const SelectionData& data) {
  if (step.decision != Decision::no_evidence) return {step, {}};  // it could not be tested
  const Term term = *step.term;
  step.log_evidence_gain =
      joint_log_evidence_gain(terms.linearised, terms.groups, terms.factors(), static_cast<int>(term));
  if (terms.has(term)) return accepted_step(step, terms, data);
  for (const TermProof& proof : terms.refused)
    if (proof.term == term) take_proof(step, proof), step.decision = proof.decision;
  if (step.decision == Decision::no_evidence) describe_unsupported(step, terms, static_cast<int>(term));
  return {step, {}};
}

}  // namespace

std::vector<WeighedStep> term_steps(const WeighedTerms& terms, const SelectionData& data) {
  std::vector<WeighedStep> steps;
  for (const SelectionStep& step : terms.candidates.steps) steps.push_back(step_of(step, terms, data));
  return steps;
}

}  // namespace kinfer::calibrate
