// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/calibration_json.hpp"

#include "kinfer/io/evidence/json/calibration_fields.hpp"
#include "kinfer/io/text/dump_json.hpp"
#include "kinfer/words/calibration/calibration.hpp"

namespace kinfer {
namespace evidence_json {

template <class Archive>
void fields(Archive& a, Value<Archive, CalibrationEvidence>& e) {
  a.constant("format", format_name);
  a.constant("kind", "calibrate");
  a("robot", e.robot);
  verdict_fields(a, e.verdict);
  a.when(e.reason.has_value(), "reason", e.reason);
  a.later("next", e.next);
  a("notes", e.notes);
  a.later("note_facts", e.note_facts);
  a.when(e.unknown_robot.has_value(), "unknown_robot", e.unknown_robot);
  a.later("findings", e.findings);
  a("holdout", e.holdout);
  a.later("wrong_rows", e.gross_error_rows);
  a.later("measured", e.measured);
  a.when(e.measurement.has_value(), "measurement", e.measurement);
  a.later("expected_holdout_rms", e.expected_holdout_rms);
  a.later("noise_holdout_rms", e.noise_holdout_rms);
  a.later("predicted_holdout_rms", e.predicted_holdout_rms);
  a.when(e.chance_of_improvement.has_value(), "chance_of_improvement", e.chance_of_improvement);
  a.when(e.unobserved_lengths.has_value(), "unobserved_lengths", e.unobserved_lengths);
  a.when(e.contradiction.has_value(), "contradiction", e.contradiction);
  a("nominal", e.nominal);
  a("before", e.before);
  a("after", e.after);
  a.when(e.iso9283.has_value(), "iso9283", e.iso9283);
  a("predicted_error", e.predicted_error);
  a("sigma", e.sigma);
  a.later("sigma_angle", e.sigma_angle);
  a("chi2_per_n", e.chi2_per_n);
  a("parameters", e.parameters);
  a("rank", e.identifiability.rank);
  a("singular_values", e.identifiability.singular_values);
  a("confounded", e.undetermined);
  a.later("undetermined", e.identifiability.undetermined);
  a("outliers", e.outliers);
  a("model", e.model);
  a("search", e.search);
  a.matrix_rows("covariance", e.covariance);
  a.group("rows", [&](auto& rows) { row_fields(rows, e.rows); });
  a("picture", e.picture);
  a.later("provenance", e.provenance);
}

}  // namespace evidence_json

nlohmann::ordered_json calibration_json(const CalibrationEvidence& evidence) {
  return evidence_json::JsonWriter::object_of(evidence);
}

std::string format_calibration_evidence(const CalibrationEvidence& evidence) {
  return dump_json(calibration_json(evidence), 1) + "\n";
}

Result<CalibrationEvidence> read_calibration_evidence(std::string_view text) {
  return evidence_json::read_text<CalibrationEvidence>(text);
}

std::string format_calibration_headline(const Calibration& c) {
  const VerdictRecord verdict{words::verdict(c), c.usability, {}};
  evidence_json::JsonWriter a;
  verdict_fields(a, verdict);
  a("before", c.before);
  a("after", c.after);
  a("rank", c.estimate.identifiability.rank);
  a("outliers", c.estimate.outliers.size());
  a("model", selected_model(c.model_selection));
  a("predicted_error", c.estimate.predicted_error);
  return dump_json(a.json()) + "\n";
}

nlohmann::ordered_json calibration_schema() {
  return evidence_json::JsonSchemaWriter::object_schema<CalibrationEvidence>();
}

}  // namespace kinfer
