// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/weighed_model.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "kinfer/calibrate/terms/ablation.hpp"
#include "kinfer/calibrate/terms/candidate_terms.hpp"
#include "kinfer/calibrate/terms/decision.hpp"
#include "kinfer/calibrate/terms/extrapolation_splits.hpp"
#include "kinfer/calibrate/validation/gross_errors.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {
namespace {

/// A model fitted to all rows, and its held-out errors: by interpolation (random folds), and by extrapolation (splits
/// along the principal directions of the joint positions).
struct ProvedModel {
  TermModel model;
  Estimate fit;
  HoldoutErrors interpolation, extrapolation;
};

/// Comparisons of a model without and with some of its terms.
struct Proof {
  ErrorChange interpolation, extrapolation;
  Decision decision = Decision::accepted;
};

std::vector<double> factors_of(const std::vector<GroupRelevance>& weights) {
  std::vector<double> factors;
  for (const GroupRelevance& group : weights) factors.push_back(group.factor);
  return factors;
}

/// Deflections follow from loads and temperatures by one number a joint, so they hold wherever the loads are known. The
/// other terms are functions of joint positions and directions that the data show only where they were measured.
bool holds_everywhere(Term term) {
  return term == Term::gravity_compliance || term == Term::torque_compliance || term == Term::thermal_expansion;
}

class ModelWeigher {
 public:
  ModelWeigher(const SelectionData& data, const Estimate& geometry)
      : data_(data), geometry_(geometry), extrapolation_splits_(extrapolation_splits(data.rows)) {}

  WeighedModel run() {
    WeighedModel result = weighed_geometry(data_, geometry_);
    candidates_ = make_candidates(geometry_, data_.task, data_.rows);
    const Estimate fitted = weigh_all();
    add_spectral_lines(candidates_, lines_of(fitted), data_.task, data_.rows);
    if (candidates_.steps.back().missing == MissingData::none) weigh_all();
    if (!current_.model.terms.empty()) {
      ProvedModel plain{{}, geometry_, result.interpolation, {}};
      plain.extrapolation = held_out(plain.fit, geometry_.parameters, extrapolation_splits_);
      prove(plain);
      result.beyond = fit_for_everywhere(plain);
    }
    describe(result);
    return result;
  }

 private:
  /// Fits all candidates, weighs their groups, and fits what is left. Returns the latter.
  Estimate weigh_all() {
    current_ = {{}, geometry_, {}, {}};
    if (candidates_.parameters.empty()) return geometry_;
    const TermModel all = model_of_all(candidates_, geometry_.parameters);
    const Estimate fitted = fit_rows(all.chain, all.parameters, data_.rows, data_.task, at_optimum(), data_.observer);
    groups_ = relevance_groups(candidates_);
    linearised_ = linearise_terms(fitted, free_indices(fitted, candidates_.parameters));
    weights_ = weigh_groups(linearised_, groups_);
    all_fitted_ = fitted;
    fit_relevant(fitted);
    return current_.fit;
  }

  /// Also of the residuals of gears alone: other terms may have taken what further harmonics would explain better.
  std::vector<SpectralLine> lines_of(const Estimate& fitted) const {
    std::vector<SpectralLine> lines = find_gear_harmonics(fitted, data_.rows, data_.threads);
    if (static_cast<int>(lines.size()) == thresholds::max_spectral_lines) return lines;
    const PoseSet rows = data_.rows.points.size() > thresholds::gears_alone_rows
                             ? select(data_.rows, thinned_rows(data_.rows, thresholds::gears_alone_rows))
                             : data_.rows;
    merge_lines(lines, find_gear_harmonics(fit_gears_alone(rows), rows, data_.threads));
    return lines;
  }

  Estimate fit_gears_alone(const PoseSet& rows) const {
    std::vector<double> factors = factors_of(weights_);
    for (std::size_t g = 0; g < groups_.size(); ++g)
      if (groups_[g].family != static_cast<int>(Term::gear_harmonics)) factors[g] = 0.0;
    const TermModel model = model_of_relevant(candidates_, geometry_, all_fitted_, groups_, factors);
    return fit_rows(model.chain, model.parameters, rows, data_.task, at_optimum(), data_.observer);
  }

  BundleOptions at_optimum() const {
    return {.initial_guess = InitialGuess::near_optimum, .detail = Detail::numbers_only, .threads = data_.threads};
  }

  void fit_relevant(const Estimate& fitted) {
    current_.model = model_of_relevant(candidates_, geometry_, fitted, groups_, factors_of(weights_));
    current_.fit = current_.model.terms.empty() ? geometry_
                                                : fit_rows(current_.model.chain, current_.model.parameters, data_.rows,
                                                           data_.task, at_optimum(), data_.observer);
  }

  HoldoutErrors held_out(const Estimate& fit, const ParameterSet& set, const std::vector<Split>& splits) const {
    return cross_validate(fit, set, data_.rows, splits, data_.task, data_.threads);
  }

  static Proof proof_of(const ProvedModel& before, const ProvedModel& after) {
    const auto& outliers = before.fit.outliers;
    Proof proof{compare_holdout(before.interpolation, outliers, after.interpolation, after.fit.outliers),
                compare_holdout(before.extrapolation, outliers, after.extrapolation, after.fit.outliers)};
    proof.decision = decide(proof.interpolation, proof.extrapolation);
    return proof;
  }

  /// [1] of the size that the marginal likelihood gives a term, 1 until held-out errors speak against it.
  double kept(Term term) const {
    const auto found = kept_.find(term);
    return found == kept_.end() ? 1.0 : found->second;
  }

  /// Held-out errors of the model with what is kept of its terms, without `removed`, from the fits with all of them.
  ProvedModel reduced(std::optional<Term> removed) const {
    const auto errors_of = [&](const HoldoutErrors& fits, const std::vector<Split>& splits) {
      return errors_with_scaled_terms(
          fits, current_.model.terms, [&](Term term) { return term == removed ? 0.0 : kept(term); }, data_.rows, splits,
          data_.threads);
    };
    return {{},
            current_.fit,
            errors_of(current_.interpolation, data_.splits),
            errors_of(current_.extrapolation, extrapolation_splits_)};
  }

  /// Terms that held-out errors speak against are kept smaller, then refused, the most harmful first. Fits what is
  /// left.
  void prove(const ProvedModel& plain) {
    current_.interpolation = held_out(current_.fit, current_.model.parameters, data_.splits);
    current_.extrapolation = held_out(current_.fit, current_.model.parameters, extrapolation_splits_);
    while (const auto harmful = most_harmful(plain)) {
      const bool is_whole = kept(harmful->first) == 1.0;
      kept_[harmful->first] = is_whole ? thresholds::softening : 0.0;
      if (!is_whole) refused_.push_back(*harmful);
    }
    if (kept_.empty()) return;
    for (std::size_t g = 0; g < groups_.size(); ++g) weights_[g].factor *= kept(static_cast<Term>(groups_[g].family));
    fit_relevant(all_fitted_);
    if (!current_.model.terms.empty())
      current_.interpolation = held_out(current_.fit, current_.model.parameters, data_.splits);
  }

  /// Geometry with the terms that hold everywhere, without the others; geometry alone where held-out ends of the joint
  /// space are predicted worse with them. None where the model has no other terms.
  std::optional<Estimate> fit_for_everywhere(const ProvedModel& plain) const {
    const auto local = [](const CandidateParameter& c) { return !holds_everywhere(c.term); };
    if (std::ranges::none_of(current_.model.terms, local)) return std::nullopt;
    std::vector<double> factors = factors_of(weights_);
    for (std::size_t g = 0; g < groups_.size(); ++g)
      if (!holds_everywhere(static_cast<Term>(groups_[g].family))) factors[g] = 0.0;
    ProvedModel loads{model_of_relevant(candidates_, geometry_, all_fitted_, groups_, factors), {}, {}, {}};
    if (loads.model.terms.empty()) return geometry_;
    loads.fit =
        fit_rows(loads.model.chain, loads.model.parameters, data_.rows, data_.task, at_optimum(), data_.observer);
    loads.extrapolation = held_out(loads.fit, loads.model.parameters, extrapolation_splits_);
    const ErrorChange change =
        compare_holdout(plain.extrapolation, plain.fit.outliers, loads.extrapolation, loads.fit.outliers);
    return change.t < -thresholds::harm_significance ? geometry_ : loads.fit;
  }

  /// The term without which held-out errors are lowest, where they speak against it or against the whole model. Keeps
  /// the comparisons of all terms.
  std::optional<std::pair<Term, Proof>> most_harmful(const ProvedModel& plain) {
    const ProvedModel present = reduced(std::nullopt);
    const Proof whole = proof_of(plain, present);
    std::optional<std::pair<Term, Proof>> worst;
    double most = 0.0;
    proofs_.clear();
    for (const TermMaker& maker : term_makers()) {
      if (!has(maker.term) || kept(maker.term) == 0.0) continue;
      const Proof proof = proof_of(reduced(maker.term), present);
      proofs_.push_back({maker.term, proof});
      if (proof.decision == Decision::accepted && whole.decision == Decision::accepted) continue;
      const double harm = -std::min(proof.interpolation.t, proof.extrapolation.t);
      if (worst && harm <= most) continue;
      most = harm, worst = {maker.term, proof.decision == Decision::accepted ? whole : proof};
    }
    return worst;
  }

  bool has(Term term) const {
    return std::ranges::any_of(current_.model.terms, [&](const CandidateParameter& c) { return c.term == term; });
  }

  void describe(WeighedModel& result) {
    for (SelectionStep step : candidates_.steps) {
      HoldoutErrors errors;
      if (step.decision == Decision::no_evidence) describe_candidate(step, errors);
      result.steps.push_back({step, errors});
    }
    std::ranges::stable_sort(result.steps, {},
                             [](const WeighedStep& s) { return s.step.term ? 1 + static_cast<int>(*s.step.term) : 0; });
    result.fit = current_.fit;
    if (!current_.model.terms.empty()) result.interpolation = current_.interpolation;
  }

  void describe_candidate(SelectionStep& step, HoldoutErrors& errors) {
    const Term term = *step.term;
    for (const auto& [refused, proof] : refused_)
      if (refused == term)
        step.decision = proof.decision, step.interpolation = proof.interpolation,
        step.extrapolation = proof.extrapolation;
    step.log_evidence_gain =
        joint_log_evidence_gain(linearised_, groups_, factors_of(weights_), static_cast<int>(term));
    if (!has(term)) {
      if (step.decision == Decision::no_evidence) describe_unsupported(step, static_cast<int>(term));
      return;
    }
    step.decision = Decision::accepted;
    for (const auto& [accepted, proof] : proofs_)
      if (accepted == term) step.interpolation = proof.interpolation, step.extrapolation = proof.extrapolation;
    for (const CandidateParameter& c : candidates_.parameters)
      if (c.term == term) count_determined(step, c.parameter.name, current_.fit);
    const auto later = [&](Term other) { return static_cast<int>(other) > static_cast<int>(term); };
    errors = errors_with_scaled_terms(
        current_.interpolation, current_.model.terms, [&](Term other) { return later(other) ? 0.0 : 1.0; }, data_.rows,
        data_.splits, data_.threads);
    std::vector<CandidateParameter> own, removed;
    for (const CandidateParameter& c : current_.model.terms) {
      if (c.term == term) own.push_back(c);
      if (later(c.term)) removed.push_back(c);
    }
    const Chain up_to_it =
        removed.empty() ? current_.fit.chain : chain_without(current_.fit, free_indices(current_.fit, removed));
    step.train = training_statistics(up_to_it, current_.fit.outliers, data_.rows);
    step.contribution = displacement(current_.fit.chain, own, data_.rows);
  }

  /// Gain of the best group of a term without support; not_excited where the data know none of its numbers better than
  /// their priors do.
  void describe_unsupported(SelectionStep& step, int term) const {
    bool excited = false;
    step.log_evidence_gain = -std::numeric_limits<double>::max();
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (groups_[g].family != term) continue;
      step.log_evidence_gain = std::max(step.log_evidence_gain, weights_[g].log_evidence_gain);
      for (const int k : groups_[g].members) excited |= linearised_.information(k, k) > 1.0;
    }
    if (!excited) step.decision = Decision::not_excited;
  }

  const SelectionData& data_;
  const Estimate& geometry_;
  std::vector<Split> extrapolation_splits_;
  CandidateTerms candidates_;
  std::vector<RelevanceGroup> groups_;
  LinearisedTerms linearised_;
  std::vector<GroupRelevance> weights_;
  Estimate all_fitted_;  ///< of all candidates
  ProvedModel current_;
  std::vector<std::pair<Term, Proof>> proofs_, refused_;
  std::map<Term, double> kept_;  ///< [1] of terms that held-out errors speak against
};

}  // namespace

WeighedModel weigh_model(const SelectionData& data, const Estimate& geometry) {
  return ModelWeigher(data, geometry).run();
}

}  // namespace kinfer::calibrate
