// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/selection/lines_or_series.hpp"

#include <algorithm>
#include <map>

#include "kinfer/base/expect.hpp"
#include "kinfer/calibrate/functions/harmonic_series.hpp"
#include "kinfer/calibrate/terms/ablation.hpp"
#include "kinfer/calibrate/terms/decision.hpp"
#include "kinfer/calibrate/terms/selection/model_weigher.hpp"
#include "kinfer/calibrate/terms/thresholds.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {
namespace {

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
  at->held_out = {{}, model.interpolation.errors, model.interpolation.row, model.interpolation.pose};
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

}  // namespace

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

}  // namespace kinfer::calibrate
