// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/selection/model_weigher.hpp"

#include <algorithm>
#include <utility>

#include "kinfer/calibrate/functions/harmonic_series.hpp"
#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/calibrate/terms/ablation.hpp"
#include "kinfer/calibrate/terms/decision.hpp"
#include "kinfer/calibrate/terms/noise_levels.hpp"
#include "kinfer/calibrate/terms/selection/term_steps.hpp"
#include "kinfer/calibrate/terms/thresholds.hpp"
#include "kinfer/calibrate/validation/extrapolation_splits.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {
namespace {

TermProof proof_of(Term term, const ProvedModel& before, const ProvedModel& after) {
  const auto& outliers = before.fit.outliers;
  TermProof proof{
      .term = term,
      .interpolation = compare_holdout(before.interpolation, outliers, after.interpolation, after.fit.outliers),
      .extrapolation = compare_holdout(before.extrapolation, outliers, after.extrapolation, after.fit.outliers)};
  proof.decision = decide(proof.interpolation, proof.extrapolation);
  return proof;
}

/// The groups of some terms alone.
template <class Keep>
std::vector<double> factors_of(const WeighedTerms& terms, const Keep& keep) {
  std::vector<double> factors = terms.factors();
  for (std::size_t g = 0; g < factors.size(); ++g)
    if (!keep(static_cast<Term>(terms.groups[g].family))) factors[g] = 0.0;
  return factors;
}

}  // namespace

std::vector<Split> splits_beyond(const PoseSet& rows) {
  return thinned(extrapolation_splits(rows), rows.pairs.empty() ? thresholds::extrapolation_rows : rows.rows());
}

ModelWeigher::ModelWeigher(const SelectionData& data, const Estimate& geometry)
    : data_(data), geometry_(geometry), extrapolation_splits_(splits_beyond(data.rows)) {}

const Estimate& ModelWeigher::fit_without_lines() {
  if (!fit_without_lines_) {
    terms_.candidates = make_candidates(geometry_, data_.task, data_.rows);
    fit_without_lines_ = weigh_all();
  }
  return *fit_without_lines_;
}

WeighedModel ModelWeigher::run() {
  WeighedModel result = weighed_geometry(data_, geometry_);
  add_spectral_lines(terms_.candidates, lines_of(fit_without_lines()), data_.task, data_.rows);
  if (terms_.candidates.steps.back().missing == MissingData::none) weigh_all();
  if (!terms_.relevant.model.terms.empty()) {
    ProvedModel plain{{}, geometry_, result.interpolation, {}};
    plain.extrapolation = held_out(plain.fit, geometry_.parameters, extrapolation_splits_);
    prove(plain);
    result.beyond = fit_for_everywhere(plain);
  }
  std::ranges::copy(term_steps(terms_, data_), std::back_inserter(result.steps));
  std::ranges::stable_sort(result.steps, {},
                           [](const WeighedStep& s) { return s.step.term ? 1 + static_cast<int>(*s.step.term) : 0; });
  result.fit = terms_.relevant.fit;
  if (!terms_.relevant.model.terms.empty()) result.interpolation = terms_.relevant.interpolation;
  return result;
}

HoldoutErrors ModelWeigher::extrapolation_of(const Estimate& fit) const {
  return held_out(fit, fit.parameters, extrapolation_splits_);
}

Estimate ModelWeigher::weigh_all() {
  terms_.relevant = {{}, geometry_, {}, {}};
  if (terms_.candidates.parameters.empty()) return geometry_;
  const TermModel all = model_of_all(terms_.candidates, geometry_.parameters);
  terms_.groups = relevance_groups(terms_.candidates);
  terms_.linearised = linearise_at_noise_levels(geometry_, all, data_.rows, data_.task.instrument);
  terms_.with_all = geometry_;
  terms_.with_all.chain = all.chain;
  if (terms_.linearised.empty()) {
    terms_.with_all = fit_rows(all.chain, all.parameters, data_.rows, data_.task, at_optimum(), data_.observer);
    terms_.linearised.push_back(
        {linearise_terms(terms_.with_all, free_indices(terms_.with_all, terms_.candidates.parameters))});
  }
  terms_.relevance = weigh_groups(terms_.linearised, terms_.groups);
  fit_relevant();
  return terms_.relevant.fit;
}

std::vector<SpectralLine> ModelWeigher::lines_of(const Estimate& fitted) const {
  std::vector<SpectralLine> lines = find_gear_harmonics(fitted, data_.rows, data_.threads);
  if (static_cast<int>(lines.size()) == thresholds::max_spectral_lines) return lines;
  const PoseSet rows = data_.rows.points.size() > thresholds::gears_alone_rows
                           ? select(data_.rows, thinned_rows(data_.rows, thresholds::gears_alone_rows))
                           : data_.rows;
  merge_lines(lines, find_gear_harmonics(fit_gears_alone(rows), rows, data_.threads));
  return lines;
}

Estimate ModelWeigher::fit_gears_alone(const PoseSet& rows) const {
  const TermModel model = model_of_relevant(terms_.candidates, geometry_, terms_.with_all, terms_.groups,
                                            factors_of(terms_, [](Term term) { return term == Term::gear_harmonics; }));
  return fit_rows(model.chain, model.parameters, rows, data_.task, at_optimum(), data_.observer);
}

void ModelWeigher::fit_relevant() {
  ProvedModel& relevant = terms_.relevant;
  relevant.model = model_of_relevant(terms_.candidates, geometry_, terms_.with_all, terms_.groups, terms_.factors());
  relevant.fit = relevant.model.terms.empty() ? geometry_
                                              : fit_rows(relevant.model.chain, relevant.model.parameters, data_.rows,
                                                         data_.task, at_optimum(), data_.observer);
}

BundleOptions ModelWeigher::at_optimum() const {
  return {.initial_guess = InitialGuess::near_optimum, .detail = Detail::numbers_only, .threads = data_.threads};
}

HoldoutErrors ModelWeigher::held_out(const Estimate& fit, const ParameterSet& set,
                                     const std::vector<Split>& splits) const {
  return cross_validate(fit, set, data_.rows, splits, data_.task, data_.threads);
}

ProvedModel ModelWeigher::reduced(std::optional<Term> term) const {
  const auto removed = [&](Term other) { return other == term || terms_.is_refused(other); };
  const ProvedModel& relevant = terms_.relevant;
  return {
      {},
      relevant.fit,
      errors_without(relevant.interpolation, relevant.model.terms, removed, data_.rows, data_.splits, data_.threads),
      errors_without(relevant.extrapolation, relevant.model.terms, removed, data_.rows, extrapolation_splits_,
                     data_.threads)};
}

void ModelWeigher::prove(const ProvedModel& plain) {
  ProvedModel& relevant = terms_.relevant;
  std::vector<HoldoutErrors> errors =
      cross_validate(relevant.fit, relevant.model.parameters, data_.rows,
                     std::vector{data_.splits, extrapolation_splits_}, data_.task, data_.threads);
  relevant.interpolation = std::move(errors[0]), relevant.extrapolation = std::move(errors[1]);
  while (const auto harmful = most_harmful(plain)) terms_.refused.push_back(*harmful);
  if (terms_.refused.empty()) return;
  for (std::size_t g = 0; g < terms_.groups.size(); ++g)
    if (terms_.is_refused(static_cast<Term>(terms_.groups[g].family))) terms_.relevance[g].factor = 0.0;
  fit_relevant();
  if (!relevant.model.terms.empty())
    relevant.interpolation = held_out(relevant.fit, relevant.model.parameters, data_.splits);
}

std::optional<TermProof> ModelWeigher::most_harmful(const ProvedModel& plain) {
  const ProvedModel present = reduced(std::nullopt);
  const TermProof whole = proof_of({}, plain, present);
  std::optional<TermProof> worst;
  double most = 0.0;
  terms_.accepted.clear();
  for (const TermMaker& maker : term_makers()) {
    if (!terms_.has(maker.term) || terms_.is_refused(maker.term)) continue;
    const TermProof proof = proof_of(maker.term, reduced(maker.term), present);
    terms_.accepted.push_back(proof);
    if (proof.decision == Decision::accepted && whole.decision == Decision::accepted) continue;
    const double harm = -std::min(proof.interpolation.t, proof.extrapolation.t);
    if (worst && harm <= most) continue;
    most = harm;
    worst = proof.decision == Decision::accepted ? whole : proof;
    worst->term = maker.term;
  }
  return worst;
}

std::optional<Estimate> ModelWeigher::fit_for_everywhere(const ProvedModel& plain) const {
  const TermModel& present = terms_.relevant.model;
  const auto most = [&](TermReach reach) {
    return std::ranges::all_of(present.terms, [&](const auto& c) { return reach_of(c.term) <= reach; });
  };
  if (most(TermReach::loads)) return std::nullopt;
  const ProvedModel loads = extended(plain, TermReach::loads), joints = extended(loads, TermReach::joints);
  if (joints.model.terms.size() == present.terms.size()) return std::nullopt;
  return joints.model.terms.empty() ? fit_beside_series(geometry_.chain, geometry_.parameters) : joints.fit;
}

ProvedModel ModelWeigher::extended(const ProvedModel& model, TermReach reach) const {
  const std::vector<double> factors = factors_of(terms_, [&](Term term) { return reach_of(term) <= reach; });
  ProvedModel more{
      model_of_relevant(terms_.candidates, geometry_, terms_.with_all, terms_.groups, factors), {}, {}, {}};
  if (more.model.terms.size() == model.model.terms.size()) return model;
  more.fit = fit_beside_series(more.model.chain, more.model.parameters);
  more.extrapolation = held_out(more.fit, more.model.parameters, extrapolation_splits_);
  const ErrorChange change =
      compare_holdout(model.extrapolation, model.fit.outliers, more.extrapolation, more.fit.outliers);
  return change.t < -thresholds::harm_significance ? model : more;
}

Estimate ModelWeigher::fit_beside_series(const Chain& start, const ParameterSet& set) const {
  return fit_bundle(with_series_of(start, terms_.relevant.fit.chain), restricted_to_data(set, data_.rows), data_.rows,
                    data_.task.instrument, at_optimum(), data_.observer);
}

}  // namespace kinfer::calibrate
