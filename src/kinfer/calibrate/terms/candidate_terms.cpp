// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/candidate_terms.hpp"

#include <algorithm>

#include "kinfer/base/expect.hpp"
#include "kinfer/calibrate/functions/chain_series.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::calibrate {
namespace {

bool is_harmonic(const JointNumber& at) {
  return at.field == Field::sine || at.field == Field::cosine;
}

/// A spectral line may fall on a harmonic of the gear: a parameter that is there twice would make the covariance of the
/// candidates singular.
void remove_known(std::vector<Parameter>& parameters, const CandidateTerms& candidates) {
  std::vector<Parameter> kept;
  for (const Parameter& parameter : parameters) {
    const bool is_candidate = std::ranges::any_of(
        candidates.parameters, [&](const CandidateParameter& c) { return c.parameter.at == parameter.at; });
    const bool is_repeated = std::ranges::any_of(kept, [&](const Parameter& p) { return p.at == parameter.at; });
    if (!is_candidate && !is_repeated) kept.push_back(parameter);
  }
  parameters = std::move(kept);
}

void add(CandidateTerms& candidates, Term term, const TermInputs& inputs) {
  ModelTerm made = make_model_term(term, candidates.chain, inputs);
  const bool has_any = !made.parameters.empty();
  remove_parts_of_series(made.parameters, made.nominal);
  if (has_any && made.parameters.empty()) {
    if (term != Term::spectral_harmonics) return;
    made.missing = MissingData::spectral_line;
  }
  remove_known(made.parameters, candidates);
  SelectionStep step{.term = term,
                     .decision = Decision::no_evidence,
                     .missing = made.missing,
                     .parameter_count = static_cast<int>(made.parameters.size()),
                     .masses_approximate = made.masses_approximate};
  if (made.missing != MissingData::none || made.parameters.empty()) {
    step.decision =
        made.parameters.empty() && made.missing == MissingData::none ? Decision::not_excited : Decision::data_missing;
  } else {
    candidates.chain = made.nominal;
    for (const Parameter& parameter : made.parameters) candidates.parameters.push_back({term, parameter});
  }
  candidates.steps.push_back(step);
}

/// Index of an entry of `list` whose `key` is that of `entry`; appended where there is none, with the value zero.
template <class Entry, class Key>
int index_of(std::vector<Entry>& list, const Entry& entry, Key Entry::*key) {
  const auto known = std::ranges::find(list, entry.*key, key);
  const auto index = static_cast<int>(known - list.begin());
  if (known == list.end()) list.push_back(entry);
  return index;
}

/// Adds to `chain` what a parameter of `rich` refers to. Returns its address there.
ParameterAddress add_structure(Chain& chain, const Chain& rich, Term term, ParameterAddress at) {
  if (term == Term::gravity_compliance) chain.masses = rich.masses;
  if (term == Term::thermal_expansion) chain.reference_temperature = rich.reference_temperature;
  auto* number = std::get_if<JointNumber>(&at);
  if (!number) return at;
  Joint& joint = chain.joints[number->joint];
  const Joint& model = rich.joints[number->joint];
  if (is_harmonic(*number)) number->term = index_of(joint.harmonics, model.harmonics[number->term], &Harmonic::order);
  if (number->field == Field::coupling)
    number->term = index_of(joint.couplings, model.couplings[number->term], &Coupling::joint);
  return at;
}

}  // namespace

CandidateTerms make_candidates(const Estimate& geometry, const CalibrationTask& task, const PoseSet& rows) {
  CandidateTerms candidates{geometry.chain, {}, {}};
  for (const TermMaker& maker : term_makers())
    if (maker.term != Term::spectral_harmonics) add(candidates, maker.term, {task.tolerances, rows});
  return candidates;
}

void add_spectral_lines(CandidateTerms& candidates, const std::vector<SpectralLine>& lines, const CalibrationTask& task,
                        const PoseSet& rows) {
  add(candidates, Term::spectral_harmonics, {task.tolerances, rows, lines});
}

void remove_parts_of_series(std::vector<Parameter>& parameters, const Chain& chain) {
  std::erase_if(parameters, [&](const Parameter& p) {
    const JointNumber* at = joint_number(p.at);
    if (!at || (at->field != Field::sine && at->field != Field::cosine)) return false;
    const Joint& joint = chain.joints[at->joint];
    return is_in_series(joint, joint.harmonics[at->term].order);
  });
}

ParameterSet with_parameters(ParameterSet set, const std::vector<Parameter>& more) {
  if (set.prior_sqrt_information.size() > 0 && !more.empty()) {
    const Eigen::Index n = set.prior_sqrt_information.cols(), m = static_cast<Eigen::Index>(more.size());
    MatrixXd rows = MatrixXd::Zero(n + m, n + m);
    rows.topLeftCorner(n, n) = set.prior_sqrt_information;
    for (Eigen::Index k = 0; k < m; ++k) rows(n + k, n + k) = 1.0 / more[k].prior_sd;
    set.prior_sqrt_information = rows;
  }
  set.parameters.insert(set.parameters.end(), more.begin(), more.end());
  return set;
}

TermModel model_of_all(const CandidateTerms& candidates, const ParameterSet& geometry) {
  std::vector<Parameter> more;
  for (const CandidateParameter& candidate : candidates.parameters) more.push_back(candidate.parameter);
  return {candidates.chain, with_parameters(geometry, more), candidates.parameters};
}

TermModel model_of_relevant(const CandidateTerms& candidates, const Estimate& geometry, const Estimate& fitted,
                            const std::vector<RelevanceGroup>& groups, const std::vector<double>& factors) {
  std::vector<double> factor(candidates.parameters.size(), 0.0);
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const int k : groups[g].members) factor[k] = factors[g];
  TermModel model{geometry.chain, geometry.parameters, {}};
  for (const Parameter* p : geometry.parameters.free()) set_value_at(model.chain, p->at, value_at(fitted.chain, p->at));
  std::vector<Parameter> more;
  for (std::size_t k = 0; k < factor.size(); ++k) {
    if (factor[k] == 0.0) continue;
    const CandidateParameter& candidate = candidates.parameters[k];
    const ParameterAddress at = add_structure(model.chain, candidates.chain, candidate.term, candidate.parameter.at);
    Parameter parameter = parameter_at(model.chain, at, factor[k] * candidate.parameter.prior_sd);
    parameter.nominal = candidate.parameter.nominal;
    set_value_at(model.chain, at, value_at(fitted.chain, candidate.parameter.at));
    more.push_back(parameter);
    model.terms.push_back({candidate.term, parameter});
  }
  model.parameters = with_parameters(geometry.parameters, more);
  return model;
}

std::vector<RelevanceGroup> relevance_groups(const CandidateTerms& candidates) {
  std::vector<RelevanceGroup> groups;
  std::vector<std::pair<int, int>> known;  // joint, and harmonic of a spectral line
  for (std::size_t k = 0; k < candidates.parameters.size(); ++k) {
    const auto& [term, parameter] = candidates.parameters[k];
    const bool is_line = term == Term::spectral_harmonics;
    const JointNumber* number = joint_number(parameter.at);
    const std::pair key{number ? number->joint : -1, number && is_line ? number->term : 0};
    std::size_t g = 0;
    while (g < groups.size() && !(groups[g].family == static_cast<int>(term) && known[g] == key)) ++g;
    if (g == groups.size()) {
      groups.push_back({{}, static_cast<int>(term), is_line});
      known.push_back(key);
    }
    groups[g].members.push_back(static_cast<int>(k));
  }
  return groups;
}

std::vector<int> free_indices(const Estimate& fit, const std::vector<CandidateParameter>& parameters) {
  const std::vector<const Parameter*> free = fit.parameters.free();
  std::vector<int> indices;
  for (const CandidateParameter& candidate : parameters) {
    const auto at = std::ranges::find_if(free, [&](const Parameter* p) { return p->at == candidate.parameter.at; });
    KINFER_EXPECT(at != free.end(), "{} is no parameter of this fit", candidate.parameter.name);
    indices.push_back(static_cast<int>(at - free.begin()));
  }
  return indices;
}

LinearisedTerms linearise_terms(const Estimate& fit, std::span<const int> indices) {
  const std::vector<const Parameter*> free = fit.parameters.free();
  const auto m = static_cast<Eigen::Index>(indices.size());
  MatrixXd covariance(m, m);
  VectorXd offset(m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const Parameter& p = *free[indices[i]];
    offset[i] = (fit.values[indices[i]].value - p.nominal) / p.prior_sd;
    for (Eigen::Index k = 0; k < m; ++k)
      covariance(i, k) = fit.covariance(indices[i], indices[k]) / (p.prior_sd * free[indices[k]]->prior_sd);
  }
  return without_own_prior(covariance, offset);
}

LinearisedTerms without_own_prior(const MatrixXd& covariance, const VectorXd& offset) {
  const Eigen::Index m = offset.size();
  const auto inverse = m > 0 ? invert_spd(covariance) : std::optional(MatrixXd(0, 0));
  if (!inverse) return {MatrixXd::Zero(m, m), VectorXd::Zero(m)};
  return {*inverse - MatrixXd::Identity(m, m), *inverse * offset};
}

}  // namespace kinfer::calibrate
