// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/calibration/calibration_evidence.hpp"

#include "kinfer/io/evidence/calibration_json.hpp"
#include "kinfer/io/evidence/make_records.hpp"
#include "kinfer/io/evidence/plot_rounding.hpp"
#include "kinfer/words/calibration/calibration.hpp"
#include "kinfer/words/calibration/model.hpp"
#include "kinfer/words/findings/outliers.hpp"
#include "kinfer/words/status.hpp"

namespace kinfer {
namespace {

std::vector<CalibrationAdviceRecord> advice_records(const std::vector<CalibrationAdvice>& list) {
  std::vector<CalibrationAdviceRecord> records;
  for (const CalibrationAdvice& advice : list) records.push_back({words::advice(advice), advice.kind, advice.values});
  return records;
}

std::vector<OutlierRecord> outlier_records(const std::vector<Outlier>& outliers) {
  std::vector<OutlierRecord> records;
  for (const Outlier& outlier : outliers) records.push_back({outlier, words::sentence(outlier)});
  return records;
}

ModelRecord model_record(const SelectionStep& step) {
  ModelRecord record{.name = std::string(name(step)),
                     .description = words::description(step),
                     .train = step.train,
                     .holdout = step.holdout,
                     .parameter_count = step.parameter_count,
                     .determined_count = step.determined_count,
                     .undetermined_parameters = step.undetermined_parameters,
                     .selected = is_selected(step),
                     .skipped = !was_tested(step),
                     .reason = words::reason(step),
                     .decision = step.decision,
                     .missing = step.missing,
                     .log_evidence_gain = step.log_evidence_gain,
                     .contribution = step.contribution};
  if (was_tested(step) && step.term)
    record.interpolation = step.interpolation, record.extrapolation = step.extrapolation;
  return record;
}

/// Without model selection, the fitted model is the only entry: "geometry".
ModelSelectionRecord model_selection_record(const Calibration& c) {
  const TrainHoldout& errors = c.after.position;
  if (c.model_selection.steps.empty())
    return {"geometry", {{.name = "geometry", .train = errors.train, .holdout = errors.holdout, .selected = true}}};
  ModelSelectionRecord record{.selected = selected_model(c.model_selection)};
  for (const SelectionStep& step : c.model_selection.steps) record.models.push_back(model_record(step));
  return record;
}

SearchRecord search_record(const SearchSummary& search) {
  SearchRecord record{search, words::sentence(search.stop)};
  record.summary.net.clear();
  return record;
}

PictureRecord picture_record(const CalibrationPlotData& plot, const Chain& calibrated) {
  return {.chains = {chain_view(plot.nominal), chain_view(plot.before), chain_view(calibrated)},
          .joints = rounded(plot.joints),
          .rows = rounded(plot.rows),
          .workspace = rounded(plot.workspace)};
}

}  // namespace

CalibrationEvidence calibration_evidence(const Calibration& c, const Provenance& provenance) {
  const Estimate& e = c.estimate;
  CalibrationEvidence evidence{.robot = e.chain.name,
                               .verdict = {words::verdict(c), c.usability, words::verdict_text(c)},
                               .reason = c.reason,
                               .next = advice_records(c.recommendations),
                               .notes = words::notes(c),
                               .note_facts = c.notes,
                               .unknown_robot = c.unknown_robot,
                               .findings = finding_records(c.findings),
                               .holdout = words::description(c.holdout),
                               .gross_error_rows = c.gross_error_rows,
                               .measured = words::measured_quantity(c.measured),
                               .measurement = c.measured,
                               .expected_holdout_rms = c.expected_holdout_rms,
                               .noise_holdout_rms = c.noise_holdout_rms,
                               .predicted_holdout_rms = c.predicted_holdout_rms,
                               .chance_of_improvement = c.chance_of_improvement,
                               .unobserved_lengths = c.unobserved_lengths,
                               .contradiction = c.contradiction,
                               .nominal = c.nominal,
                               .before = c.before,
                               .after = c.after,
                               .predicted_error = e.predicted_error,
                               .sigma = e.sigma,
                               .sigma_angle = e.sigma_angle,
                               .chi2_per_n = e.chi2_per_n,
                               .parameters = e.values,
                               .identifiability = e.identifiability,
                               .undetermined = words::undetermined_sentences(e.identifiability),
                               .outliers = outlier_records(e.outliers),
                               .model = model_selection_record(c),
                               .search = search_record(e.search),
                               .covariance = e.covariance,
                               .rows = c.rows,
                               .picture = picture_record(c.plot_data, e.chain),
                               .provenance = provenance_record(provenance)};
  if (!c.accuracy.empty()) evidence.iso9283 = accuracy_statistics(c.accuracy);
  return evidence;
}

}  // namespace kinfer
