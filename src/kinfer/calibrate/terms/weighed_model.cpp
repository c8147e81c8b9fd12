// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/weighed_model.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "kinfer/base/expect.hpp"
#include "kinfer/calibrate/functions/harmonic_series.hpp"
#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/calibrate/terms/ablation.hpp"
#include "kinfer/calibrate/terms/candidate_terms.hpp"
#include "kinfer/calibrate/terms/decision.hpp"
#include "kinfer/calibrate/terms/extrapolation_splits.hpp"
#include "kinfer/calibrate/terms/noise_levels.hpp"
#include "kinfer/calibrate/terms/weighed_field.hpp"
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

/// Where a term holds that was found among the fitted rows.
enum class TermReach {
  loads,    ///< one number a joint, wherever loads and temperatures are known
  joints,   ///< numbers of a joint's encoder and gear, as long as held-out ends of the joint space do not speak against
  measured  ///< a function of joint positions, where it was measured
};

TermReach reach_of(Term term) {
  switch (term) {
    case Term::gravity_compliance:
    case Term::torque_compliance:
    case Term::thermal_expansion:
      return TermReach::loads;
    case Term::gain:
    case Term::backlash:
      return TermReach::joints;
    default:
      return TermReach::measured;
  }
}

/// Splits along the principal directions of the joint positions, of a part of many rows.
std::vector<Split> splits_beyond(const PoseSet& rows) {
  return thinned(extrapolation_splits(rows), rows.pairs.empty() ? thresholds::extrapolation_rows : rows.rows());
}

class ModelWeigher {
 public:
  ModelWeigher(const SelectionData& data, const Estimate& geometry)
      : data_(data), geometry_(geometry), extrapolation_splits_(splits_beyond(data.rows)) {}

  /// The fit of the relevant terms but spectral lines.
  const Estimate& fit_without_lines() {
    if (!fit_without_lines_) {
      candidates_ = make_candidates(geometry_, data_.task, data_.rows);
      fit_without_lines_ = weigh_all();
    }
    return *fit_without_lines_;
  }

  WeighedModel run() {
    WeighedModel result = weighed_geometry(data_, geometry_);
    add_spectral_lines(candidates_, lines_of(fit_without_lines()), data_.task, data_.rows);
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

  /// Held-out errors of a model beyond the fitted poses.
  HoldoutErrors extrapolation_of(const Estimate& fit) const {
    return held_out(fit, fit.parameters, extrapolation_splits_);
  }

 private:
  /// Weighs the groups of all candidates about the fit of all, or of geometry, and fits what is left. Returns the
  /// latter.
  Estimate weigh_all() {
    current_ = {{}, geometry_, {}, {}};
    if (candidates_.parameters.empty()) return geometry_;
    const TermModel all = model_of_all(candidates_, geometry_.parameters);
    groups_ = relevance_groups(candidates_);
    linearised_ = linearise_at_noise_levels(geometry_, all, data_.rows, data_.task.instrument);
    Estimate fitted = geometry_;
    fitted.chain = all.chain;
    if (linearised_.empty()) {
      fitted = fit_rows(all.chain, all.parameters, data_.rows, data_.task, at_optimum(), data_.observer);
      linearised_.push_back({linearise_terms(fitted, free_indices(fitted, candidates_.parameters))});
    }
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

  bool is_refused(Term term) const {
    return std::ranges::any_of(refused_, [&](const auto& refused) { return refused.first == term; });
  }

  /// Held-out errors of the model without the refused terms and without `term`, from the fits with all of them.
  ProvedModel reduced(std::optional<Term> term) const {
    const auto removed = [&](Term other) { return other == term || is_refused(other); };
    return {
        {},
        current_.fit,
        errors_without(current_.interpolation, current_.model.terms, removed, data_.rows, data_.splits, data_.threads),
        errors_without(current_.extrapolation, current_.model.terms, removed, data_.rows, extrapolation_splits_,
                       data_.threads)};
  }

  /// Refuses the terms that held-out errors speak against, the most harmful first, and fits what is left.
  void prove(const ProvedModel& plain) {
    std::vector<HoldoutErrors> errors =
        cross_validate(current_.fit, current_.model.parameters, data_.rows,
                       std::vector{data_.splits, extrapolation_splits_}, data_.task, data_.threads);
    current_.interpolation = std::move(errors[0]), current_.extrapolation = std::move(errors[1]);
    while (const auto harmful = most_harmful(plain)) refused_.push_back(*harmful);
    if (refused_.empty()) return;
    for (std::size_t g = 0; g < groups_.size(); ++g)
      if (is_refused(static_cast<Term>(groups_[g].family))) weights_[g].factor = 0.0;
    fit_relevant(all_fitted_);
    if (!current_.model.terms.empty())
      current_.interpolation = held_out(current_.fit, current_.model.parameters, data_.splits);
  }

  /// Geometry with the terms that hold everywhere, without the others; without those that make held-out ends of the
  /// joint space worse. None where the whole model holds everywhere.
  std::optional<Estimate> fit_for_everywhere(const ProvedModel& plain) const {
    const auto most = [&](TermReach reach) {
      return std::ranges::all_of(current_.model.terms, [&](const auto& c) { return reach_of(c.term) <= reach; });
    };
    if (most(TermReach::loads)) return std::nullopt;
    const ProvedModel loads = extended(plain, TermReach::loads), joints = extended(loads, TermReach::joints);
    if (joints.model.terms.size() == current_.model.terms.size()) return std::nullopt;
    return joints.model.terms.empty() ? fit_beside_series(geometry_.chain, geometry_.parameters) : joints.fit;
  }

  /// The model with all terms of that reach, where held-out ends of the joint space do not speak against these.
  ProvedModel extended(const ProvedModel& model, TermReach reach) const {
    std::vector<double> factors = factors_of(weights_);
    for (std::size_t g = 0; g < groups_.size(); ++g)
      if (reach_of(static_cast<Term>(groups_[g].family)) > reach) factors[g] = 0.0;
    ProvedModel more{model_of_relevant(candidates_, geometry_, all_fitted_, groups_, factors), {}, {}, {}};
    if (more.model.terms.size() == model.model.terms.size()) return model;
    more.fit = fit_beside_series(more.model.chain, more.model.parameters);
    more.extrapolation = held_out(more.fit, more.model.parameters, extrapolation_splits_);
    const ErrorChange change =
        compare_holdout(model.extrapolation, model.fit.outliers, more.extrapolation, more.fit.outliers);
    return change.t < -thresholds::harm_significance ? model : more;
  }

  /// With the series of the present model as they are: they end at the measured positions by themselves.
  Estimate fit_beside_series(const Chain& start, const ParameterSet& set) const {
    return fit_bundle(with_series_of(start, current_.fit.chain), restricted_to_data(set, data_.rows), data_.rows,
                      data_.task.instrument, at_optimum(), data_.observer);
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
      if (!has(maker.term) || is_refused(maker.term)) continue;
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
    errors =
        errors_without(current_.interpolation, current_.model.terms, later, data_.rows, data_.splits, data_.threads);
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
      for (const int k : groups_[g].members) excited |= without_terms(linearised_).information(k, k) > 1.0;
    }
    if (!excited) step.decision = Decision::not_excited;
  }

  const SelectionData& data_;
  const Estimate& geometry_;
  std::vector<Split> extrapolation_splits_;
  CandidateTerms candidates_;
  std::vector<RelevanceGroup> groups_;
  std::vector<TermsAtNoise> linearised_;
  std::vector<GroupRelevance> weights_;
  Estimate all_fitted_;  ///< with all candidates: where the fit of what is left begins
  std::optional<Estimate> fit_without_lines_;
  ProvedModel current_;
  std::vector<std::pair<Term, Proof>> proofs_, refused_;
};

/// Adds what series contribute to the step of harmonics that were found in the residuals.
void describe_series(WeighedModel& model, const FoundSeries& found, const ErrorChange& interpolation,
                     const ErrorChange& extrapolation, const PoseSet& rows) {
  const auto is_spectrum = [](const WeighedStep& s) { return s.step.term == Term::spectral_harmonics; };
  const auto at = std::ranges::find_if(model.steps, is_spectrum);
  KINFER_EXPECT(at != model.steps.end(), "every model has a step of harmonics in the residuals");
  SelectionStep& step = at->step;
  if (step.decision != Decision::accepted) step = {.term = Term::spectral_harmonics};
  step.decision = Decision::accepted;
  step.log_evidence_gain += found.log_evidence_gain;
  for (const Joint& joint : found.chain.joints)
    if (const int order = series_order(joint); order > 0)
      step.parameter_count += 2 * order + 1, step.determined_count += 2 * order + 1;
  step.interpolation = interpolation, step.extrapolation = extrapolation;
  step.train = training_statistics(model.fit.chain, model.fit.outliers, rows);
  step.contribution = rms_distance(model.fit.chain, without_series(model.fit.chain), rows);
  at->held_out = {{}, model.interpolation.errors, model.interpolation.row};
}

/// Models with lines and with series, and what the latter change.
struct Comparison {
  WeighedModel lines, series;
  ErrorChange interpolation, extrapolation;

  bool favours_series() const {
    return decide(interpolation, extrapolation) == Decision::accepted &&
           interpolation.t >= thresholds::harm_significance;
  }
};

Estimate fit_beside(const SelectionData& data, const Estimate& geometry, const FoundSeries& found) {
  return fit_rows(with_series_of(geometry.chain, found.chain), geometry.parameters, data.rows, data.task,
                  {.initial_guess = InitialGuess::near_optimum, .threads = data.threads}, data.observer);
}

Comparison compare(const SelectionData& data, ModelWeigher& of_lines, const Estimate& geometry,
                   const FoundSeries& found) {
  const Estimate beside = fit_beside(data, geometry, found);
  ModelWeigher of_series(data, beside);
  Comparison c{of_lines.run(), of_series.run(), {}, {}};
  c.interpolation =
      compare_holdout(c.lines.interpolation, c.lines.fit.outliers, c.series.interpolation, c.series.fit.outliers);
  c.extrapolation = compare_holdout(of_lines.extrapolation_of(c.lines.fit), c.lines.fit.outliers,
                                    of_series.extrapolation_of(c.series.fit), c.series.fit.outliers);
  return c;
}

/// The splits of some rows, counted among these.
std::vector<Split> splits_of_part(const std::vector<Split>& splits, const std::vector<int>& part) {
  std::map<int, int> index;
  for (const int row : part) index.emplace(row, static_cast<int>(index.size()));
  const auto among = [&](const std::vector<int>& rows) {
    std::vector<int> kept;
    for (const int row : rows)
      if (const auto at = index.find(row); at != index.end()) kept.push_back(at->second);
    return kept;
  };
  std::vector<Split> of_part;
  for (const Split& split : splits) of_part.push_back({among(split.train), among(split.holdout)});
  return of_part;
}

/// Models of terms, the best one first; of few rows also that of lines, where series are better.
std::vector<WeighedModel> weigh_terms(const SelectionData& data, const Estimate& geometry) {
  ModelWeigher of_lines(data, geometry);
  const auto found = find_series(of_lines.fit_without_lines(), data.rows, data.task.instrument, data.threads);
  if (!found) return {of_lines.run()};
  if (static_cast<std::size_t>(data.rows.rows()) <= thresholds::compared_rows) {
    Comparison c = compare(data, of_lines, geometry, *found);
    if (!c.favours_series()) return {c.lines};
    describe_series(c.series, *found, c.interpolation, c.extrapolation, data.rows);
    return {c.series, c.lines};
  }
  const std::vector<int> part = thinned_rows(data.rows, thresholds::compared_rows);
  const PoseSet rows = select(data.rows, part);
  const std::vector<Split> splits = splits_of_part(data.splits, part);
  const SelectionData fewer{data.task, rows, splits, data.threads, data.observer};
  ModelWeigher lines_of_part(fewer, geometry);
  const Comparison c = compare(fewer, lines_of_part, geometry, *found);
  if (!c.favours_series()) return {of_lines.run()};
  const Estimate beside = fit_beside(data, geometry, *found);
  WeighedModel series = ModelWeigher(data, beside).run();
  describe_series(series, *found, c.interpolation, c.extrapolation, data.rows);
  return {series};
}

/// Whether held-out errors are lower with the other model, and none of their points speaks against it.
bool is_better(const WeighedModel& other, const WeighedModel& present, const SelectionData& data,
               const std::vector<Split>& beyond) {
  const auto errors_beyond = [&](const WeighedModel& model) {
    return cross_validate(model.fit, model.fit.parameters, data.rows, beyond, data.task, data.threads);
  };
  const ErrorChange inside =
      compare_holdout(present.interpolation, present.fit.outliers, other.interpolation, other.fit.outliers);
  const ErrorChange outside =
      compare_holdout(errors_beyond(present), present.fit.outliers, errors_beyond(other), other.fit.outliers);
  return inside.t > 0.0 && decide(inside, outside) == Decision::accepted;
}

}  // namespace

WeighedModel weigh_model(const SelectionData& data, const Estimate& geometry) {
  std::vector<WeighedModel> models = weigh_terms(data, geometry);
  const std::vector<Split> beyond = splits_beyond(data.rows);
  for (WeighedModel& model : models) weigh_field(data, beyond, model);
  WeighedModel& best = models.front();
  for (const WeighedModel& other : models)
    if (!other.fit.chain.field.empty() && best.fit.chain.field.empty() && is_better(other, best, data, beyond))
      best = other;
  return best;
}

}  // namespace kinfer::calibrate
