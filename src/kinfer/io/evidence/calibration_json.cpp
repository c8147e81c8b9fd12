// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/calibration_json.hpp"

#include <nlohmann/json.hpp>

#include "kinfer/io/evidence/drawing_json.hpp"
#include "kinfer/io/evidence/findings_json.hpp"
#include "kinfer/io/evidence/json_parts.hpp"
#include "kinfer/words/calibration.hpp"
#include "kinfer/words/calibration_model.hpp"
#include "kinfer/words/calibration_outliers.hpp"

namespace kinfer {
namespace {

using Json = nlohmann::ordered_json;

Json array_of(const VectorXd& values) {
  return std::vector<double>(values.begin(), values.end());
}

Json array_of(const MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) rows.push_back(array_of(VectorXd(matrix.row(i).transpose())));
  return rows;
}

Json json_of(const ErrorStatistics& s) {
  return {{"mean", s.mean}, {"rms", s.rms}, {"sd", s.sd}, {"max", s.max}, {"n", s.n}};
}

Json json_of(const ChainFit& fit) {
  const auto sides = [](const TrainHoldout& errors) {
    return Json{{"train", json_of(errors.train)},
                {"holdout", json_of(errors.holdout)},
                {"holdout_all_rows", json_of(errors.holdout_all_rows)}};
  };
  Json json = sides(fit.position);
  if (fit.orientation.train.n > 0) json["orientation_rad"] = sides(fit.orientation);
  return json;
}

Json parameters_json(const Estimate& estimate) {
  Json list = Json::array();
  for (const ParameterEstimate& p : estimate.values)
    list.push_back({{"name", p.name},
                    {"nominal", p.nominal},
                    {"value", p.value},
                    {"sd", p.sd},
                    {"unit", unit(p.quantity)},
                    {"identifiable", p.identifiable}});
  return list;
}

Json outliers_json(const std::vector<Outlier>& outliers) {
  Json list = Json::array();
  for (const Outlier& o : outliers) {
    Json measurements = Json::array();
    for (const OutlierReason& r : o.reasons)
      measurements.push_back({{"kind", name(r.kind)}, {"residual", r.residual}, {"sigmas", r.sigmas}});
    list.push_back({{"row", o.row},
                    {"line", o.line},
                    {"reason", words::sentence(o)},
                    {"measurements", measurements},
                    {"sigmas", o.sigmas},
                    {"held_out", o.held_out}});
  }
  return list;
}

Json undetermined_json(const Identifiability& identifiability) {
  Json list = Json::array();
  for (const UndeterminedGroup& group : identifiability.undetermined)
    list.push_back({{"reason", name(group.reason)}, {"parameters", group.parameters}});
  return list;
}

Json notes_json(const std::vector<CalibrationNote>& notes) {
  Json list = Json::array();
  for (const CalibrationNote& note : notes)
    list.push_back({{"kind", name(note.kind)}, {"values", values_json(note.values)}});
  return list;
}

Json recommendations_json(const std::vector<CalibrationAdvice>& list) {
  Json json = Json::array();
  for (const CalibrationAdvice& advice : list) {
    const auto [what, why] = words::advice(advice);
    json.push_back({{"what", what}, {"why", why}, {"kind", name(advice.kind)}, {"values", values_json(advice.values)}});
  }
  return json;
}

Json unknown_robot_json(const UnknownRobotEvidence& robot) {
  Json axes = Json::array();
  for (const AxisPair& pair : robot.axes.pairs)
    axes.push_back({{"joints", {pair.first, pair.second}},
                    {"relation", name(pair.relation)},
                    {"angle_rad", pair.angle},
                    {"distance_m", pair.distance ? Json(*pair.distance) : Json(nullptr)}});
  return {{"starts", robot.starts},
          {"agreeing", robot.agreeing},
          {"median_error", robot.median_error},
          {"axes", axes},
          {"wrists", robot.axes.wrists}};
}

Json rows_json(const std::vector<RowErrors>& rows) {
  Json row = Json::array(), before = Json::array(), after = Json::array(), fitted = Json::array(), held = Json::array();
  for (const RowErrors& r : rows) {
    row.push_back(r.row);
    before.push_back(finite_json(r.before));
    after.push_back(finite_json(r.after));
    fitted.push_back(finite_json(r.fitted));
    held.push_back(r.held_out);
  }
  return {{"row", row}, {"before", before}, {"after", after}, {"fitted", fitted}, {"held_out", held}};
}

/// ISO 9283: accuracy over all poses, repeatability over the repeated ones.
Json iso9283_json(const std::vector<PoseAccuracy>& poses) {
  const auto [before, after, repeatability] = accuracy_statistics(poses);
  return {{"pose_accuracy_before", json_of(before)},
          {"pose_accuracy_after", json_of(after)},
          {"pose_repeatability", json_of(repeatability)}};
}

Json side_by_side_json(const std::vector<SearchRun>& runs) {
  Json list = Json::array();
  for (const SearchRun& run : runs)
    list.push_back({{"start", name(run.initial)},
                    {"iterations", run.iterations < 0 ? Json(nullptr) : Json(run.iterations)},
                    {"evaluations", run.evaluations},
                    {"rms", run.rms}});
  return list;
}

/// How the optimiser ran: engine, effort, why it stopped, cost history.
Json search_json(const SearchSummary& search) {
  Json json{{"engine", name(search.method)},
            {"iterations", search.iterations},
            {"evaluations", search.evaluations},
            {"stop", name(search.stop)},
            {"stop_words", sentence(search.stop)},
            {"cost", finite_json(search.cost)},
            {"best", search.best},
            {"median", search.median}};
  if (!search.swarm_comparison.empty()) json["side_by_side"] = side_by_side_json(search.swarm_comparison);
  return json;
}

Json change_json(const ErrorChange& change) {
  return {{"mean_before", change.mean_before},
          {"mean_after", change.mean_after},
          {"worst_before", change.worst_before},
          {"worst_after", change.worst_after},
          {"standard_errors", finite_json(change.t)}};
}

Json step_json(const SelectionStep& step) {
  Json json{{"name", name(step)}, {"adds", words::description(step)}};
  if (was_tested(step)) json["train"] = json_of(step.train), json["holdout"] = json_of(step.holdout);
  json["terms"] = step.parameter_count;
  json["determined"] = step.determined_count;
  json["not_excited"] = step.undetermined_parameters;
  json["chosen"] = is_selected(step);
  json["locked"] = !was_tested(step);
  json["why"] = words::reason(step);
  json["decision"] = name(step.decision);
  json["missing"] = name(step.missing);
  if (was_tested(step) && step.term) {
    json["interpolation"] = change_json(step.interpolation);
    json["extrapolation"] = change_json(step.extrapolation);
  }
  return json;
}

/// Without model selection, the fitted model is the only entry.
Json fitted_model_json(const TrainHoldout& errors) {
  return {
      {"name", "geometry"}, {"adds", ""},      {"train", json_of(errors.train)}, {"holdout", json_of(errors.holdout)},
      {"terms", 0},         {"determined", 0}, {"not_excited", Json::array()},   {"chosen", true},
      {"locked", false},    {"why", ""}};
}

Json model_json(const Calibration& c) {
  if (c.model_selection.steps.empty())
    return {{"chosen", "geometry"}, {"rungs", Json::array({fitted_model_json(c.after.position)})}};
  Json steps = Json::array();
  for (const SelectionStep& step : c.model_selection.steps) steps.push_back(step_json(step));
  return {{"chosen", selected_model(c.model_selection)}, {"rungs", steps}};
}

}  // namespace

std::string format_calibration_evidence(const Calibration& c, const Provenance& provenance) {
  const Estimate& e = c.estimate;
  Json json;
  json["format"] = "kinfer-evidence/1";
  json["kind"] = "calibrate";
  json["robot"] = e.chain.name;
  json["verdict"] = words::verdict(c);
  json["use"] = c.usability != Usability::do_not_use;
  json["usability"] = name(c.usability);
  json["reason"] = name(c.reason);
  json["next"] = recommendations_json(c.recommendations);
  json["notes"] = words::notes(c);
  json["note_facts"] = notes_json(c.notes);
  if (c.unknown_robot) json["unknown_robot"] = unknown_robot_json(*c.unknown_robot);
  json["findings"] = Json::parse(format_findings(c.findings));
  json["holdout"] = words::description(c.holdout);
  json["wrong_rows"] = c.gross_error_rows;
  json["measured"] = words::measured_quantity(c.measured);
  json["measurement"] = name(c.measured);
  json["expected_holdout_rms"] = c.expected_holdout_rms ? Json(*c.expected_holdout_rms) : Json(nullptr);
  json["nominal"] = json_of(c.nominal);
  json["before"] = json_of(c.before);
  json["after"] = json_of(c.after);
  if (!c.accuracy.empty()) json["iso9283"] = iso9283_json(c.accuracy);
  json["predicted_error"] = e.predicted_error;
  json["sigma"] = e.sigma;
  json["sigma_angle"] = e.sigma_angle;
  json["chi2_per_n"] = e.chi2_per_n ? Json(*e.chi2_per_n) : Json(nullptr);
  json["parameters"] = parameters_json(e);
  json["rank"] = e.identifiability.rank;
  json["singular_values"] = array_of(e.identifiability.singular_values);
  json["confounded"] = words::undetermined_sentences(e.identifiability);
  json["undetermined"] = undetermined_json(e.identifiability);
  json["outliers"] = outliers_json(e.outliers);
  json["model"] = model_json(c);
  json["search"] = search_json(e.search);
  json["covariance"] = array_of(e.covariance);
  json["rows"] = rows_json(c.rows);
  json["picture"] = picture_json(c.plot_data, e.chain);
  json["provenance"] = provenance_json(provenance);
  return json.dump(1) + "\n";
}

std::string format_calibration_headline(const Calibration& c) {
  const Json json{{"verdict", words::verdict(c)},
                  {"use", c.usability != Usability::do_not_use},
                  {"usability", name(c.usability)},
                  {"before", json_of(c.before)},
                  {"after", json_of(c.after)},
                  {"rank", c.estimate.identifiability.rank},
                  {"outliers", c.estimate.outliers.size()},
                  {"model", selected_model(c.model_selection)},
                  {"predicted_error", c.estimate.predicted_error}};
  return json.dump() + "\n";
}

}  // namespace kinfer
