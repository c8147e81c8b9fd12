// SPDX-License-Identifier: Apache-2.0
// Members of the structs of a calibration, in the order of the file.
#pragma once

#include "kinfer/evidence/calibration/calibration_evidence.hpp"
#include "kinfer/io/evidence/json/shared_fields.hpp"

namespace kinfer::evidence_json {

template <class Archive>
void fields(Archive& a, Value<Archive, ErrorStatistics>& s) {
  a("mean", s.mean);
  a("rms", s.rms);
  a("sd", s.sd);
  a("max", s.max);
  a("n", s.n);
}

template <class Archive>
void fields(Archive& a, Value<Archive, TrainHoldout>& errors) {
  a("train", errors.train);
  a("holdout", errors.holdout);
  a.later("holdout_all_rows", errors.holdout_all_rows);
}

template <class Archive>
void fields(Archive& a, Value<Archive, ChainFit>& fit) {
  fields(a, fit.position);
  a.when(fit.orientation.train.n > 0, "orientation_rad", fit.orientation);
}

template <class Archive>
void fields(Archive& a, Value<Archive, AccuracyStatistics>& iso) {
  a("pose_accuracy_before", iso.before);
  a("pose_accuracy_after", iso.after);
  a("pose_repeatability", iso.repeatability);
}

template <class Archive>
void fields(Archive& a, Value<Archive, ParameterEstimate>& p) {
  a("name", p.name);
  a("nominal", p.nominal);
  a("value", p.value);
  a("sd", p.sd);
  a("unit", p.quantity);
  a("identifiable", p.identifiable);
}

template <class Archive>
void fields(Archive& a, Value<Archive, UnobservedLengths>& unobserved) {
  a("kind", unobserved.kind);
  a("relative_sd", unobserved.relative_sd);
}

template <class Archive>
void fields(Archive& a, Value<Archive, Contradiction>& contradiction) {
  a("kind", contradiction.kind);
  a("contradicted", contradiction.contradicted);
  a("measured", contradiction.measured);
  a("error", contradiction.error);
  a("noise", contradiction.noise);
}

template <class Archive>
void fields(Archive& a, Value<Archive, UndeterminedGroup>& group) {
  a("reason", group.reason);
  a("parameters", group.parameters);
}

template <class Archive>
void fields(Archive& a, Value<Archive, OutlierReason>& reason) {
  a("kind", reason.kind);
  a("residual", reason.residual);
  a("sigmas", reason.sigmas);
}

template <class Archive>
void fields(Archive& a, Value<Archive, OutlierRecord>& record) {
  auto& outlier = record.outlier;
  a("row", outlier.row);
  a("line", outlier.line);
  a("reason", record.reason);
  a.later("measurements", outlier.reasons);
  a.later("sigmas", outlier.sigmas);
  a.later("held_out", outlier.held_out);
}

template <class Archive>
void fields(Archive& a, Value<Archive, CalibrationAdviceRecord>& advice) {
  fields(a, advice.text);
  a.when(advice.kind.has_value(), "kind", advice.kind);
  a.when(advice.kind.has_value(), "values", advice.values);
}

template <class Archive>
void fields(Archive& a, Value<Archive, CalibrationNote>& note) {
  a("kind", note.kind);
  a("values", note.values);
}

template <class Archive>
void fields(Archive& a, Value<Archive, AxisPair>& axes) {
  std::array joints{axes.first, axes.second};
  a("joints", joints);
  if constexpr (!Archive::is_writer) axes.first = joints[0], axes.second = joints[1];
  a("relation", axes.relation);
  a("angle_rad", axes.angle);
  a("distance_m", axes.distance);
}

template <class Archive>
void fields(Archive& a, Value<Archive, UnknownRobotEvidence>& robot) {
  a("starts", robot.starts);
  a("agreeing", robot.agreeing);
  a("median_error", robot.median_error);
  a("axes", robot.axes.pairs);
  a("wrists", robot.axes.wrists);
}

template <class Archive>
void fields(Archive& a, Value<Archive, QuantileChange>& change) {
  a("before", change.before);
  a("after", change.after);
  a("rise_probability", change.rise_probability);
}

template <class Archive>
void fields(Archive& a, Value<Archive, ErrorChange>& change) {
  a("mean_before", change.mean_before);
  a("mean_after", change.mean_after);
  a("worst_before", change.worst_before);
  a("worst_after", change.worst_after);
  a("standard_errors", change.t);
  a.later("p95", change.p95);
  a.later("p99", change.p99);
}

template <class Archive>
void fields(Archive& a, Value<Archive, ModelRecord>& model) {
  a("name", model.name);
  a("adds", model.description);
  a.when(!model.skipped, "train", model.train);
  a.when(!model.skipped, "holdout", model.holdout);
  a("terms", model.parameter_count);
  a("determined", model.determined_count);
  a("not_excited", model.undetermined_parameters);
  a("chosen", model.selected);
  a("locked", model.skipped);
  a("why", model.reason);
  a.when(model.decision.has_value(), "decision", model.decision);
  a.when(model.missing.has_value(), "missing", model.missing);
  a.when(model.interpolation.has_value(), "interpolation", model.interpolation);
  a.when(model.extrapolation.has_value(), "extrapolation", model.extrapolation);
  a.later("log_evidence_gain", model.log_evidence_gain);
  a.later("contribution", model.contribution);
}

template <class Archive>
void fields(Archive& a, Value<Archive, ModelSelectionRecord>& selection) {
  a("chosen", selection.selected);
  a("rungs", selection.models);
}

template <class Archive>
void fields(Archive& a, Value<Archive, SearchRun>& run) {
  a("start", run.initial);
  a.known(run.iterations >= 0, "iterations", run.iterations);
  a("evaluations", run.evaluations);
  a("rms", run.rms);
}

template <class Archive>
void fields(Archive& a, Value<Archive, SearchRecord>& record) {
  auto& search = record.summary;
  a("engine", search.method);
  a("iterations", search.iterations);
  a("evaluations", search.evaluations);
  a("stop", search.stop);
  a("stop_words", record.stop_sentence);
  a("cost", search.cost);
  a("best", search.best);
  a("median", search.median);
  a.when(!search.swarm_comparison.empty(), "side_by_side", search.swarm_comparison);
}

template <class Archive>
void row_fields(Archive& a, Value<Archive, std::vector<RowErrors>>& rows) {
  a.column("row", rows, &RowErrors::row);
  a.column("before", rows, &RowErrors::before);
  a.column("after", rows, &RowErrors::after);
  a.column("fitted", rows, &RowErrors::fitted);
  a.column("held_out", rows, &RowErrors::held_out);
}

template <class Archive>
void fields(Archive& a, Value<Archive, ChainRecords>& chains) {
  a("nominal", chains.nominal);
  a("before", chains.before);
  a("calibrated", chains.calibrated);
}

template <class Archive>
void fields(Archive& a, Value<Archive, PictureRecord>& picture) {
  a("chains", picture.chains);
  a.matrix_columns("q", picture.joints);
  a.column("measured", picture.rows, &PlotRow::measured);
  a.column("off_before", picture.rows, &PlotRow::error_before);
  a.column("off_after", picture.rows, &PlotRow::error_after);
  a.plotted_column("predicted", picture.rows, &PlotRow::predicted);
  a.group("workspace", [&](auto& workspace) {
    workspace.column("tool", picture.workspace, &WorkspacePoint::tool);
    workspace.plotted_column("predicted", picture.workspace, &WorkspacePoint::predicted);
  });
}

}  // namespace kinfer::evidence_json
