// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/calibration_json.hpp"

#include <nlohmann/json.hpp>

#include "kinfer/io/evidence/drawing_json.hpp"
#include "kinfer/io/evidence/findings_json.hpp"
#include "kinfer/io/evidence/json_parts.hpp"

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
  for (const Outlier& o : outliers) list.push_back({{"row", o.row}, {"line", o.line}, {"reason", o.reason}});
  return list;
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
  std::vector<double> before, after, repeatability;
  for (const PoseAccuracy& pose : poses) {
    before.push_back(pose.accuracy_before), after.push_back(pose.accuracy_after);
    if (pose.repeatability) repeatability.push_back(*pose.repeatability);
  }
  return {{"pose_accuracy_before", json_of(error_statistics(before))},
          {"pose_accuracy_after", json_of(error_statistics(after))},
          {"pose_repeatability", json_of(error_statistics(repeatability))}};
}

Json side_by_side_json(const std::vector<SearchRun>& runs) {
  Json list = Json::array();
  for (const SearchRun& run : runs)
    list.push_back({{"start", run.name},
                    {"iterations", run.iterations < 0 ? Json(nullptr) : Json(run.iterations)},
                    {"evaluations", run.evaluations},
                    {"rms", run.rms}});
  return list;
}

/// How the optimiser ran: engine, effort, why it stopped, cost history.
Json search_json(const SearchSummary& search) {
  Json json{{"engine", search.method},
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

/// Without model selection, the fitted model is the only entry.
Json model_json(const Calibration& c) {
  ModelSelection model_selection = c.model_selection;
  if (model_selection.model_terms.empty())
    model_selection.model_terms.push_back(
        {.name = "geometry", .train = c.after.position.train, .holdout = c.after.position.holdout, .selected = true});
  if (model_selection.selected.empty()) model_selection.selected = model_selection.model_terms.front().name;
  Json model_terms = Json::array();
  for (const SelectionStep& r : model_selection.model_terms) {
    Json model_term{{"name", r.name}, {"adds", r.description}};
    if (!r.skipped) model_term["train"] = json_of(r.train), model_term["holdout"] = json_of(r.holdout);
    model_term["terms"] = r.parameter_count;
    model_term["determined"] = r.determined_count;
    model_term["not_excited"] = r.undetermined_parameters;
    model_term["chosen"] = r.selected;
    model_term["locked"] = r.skipped;
    model_term["why"] = r.reason;
    model_terms.push_back(model_term);
  }
  return {{"chosen", model_selection.selected}, {"rungs", model_terms}};
}

}  // namespace

std::string format_calibration_evidence(const Calibration& c, const Provenance& provenance) {
  const Estimate& e = c.estimate;
  Json json;
  json["format"] = "kinfer-evidence/1";
  json["kind"] = "calibrate";
  json["robot"] = e.chain.name;
  json["verdict"] = c.verdict;
  json["use"] = c.usable;
  json["next"] = advice_json(c.recommendations);
  json["notes"] = c.notes;
  json["findings"] = Json::parse(format_findings(c.findings));
  json["holdout"] = c.holdout;
  json["wrong_rows"] = c.gross_error_rows;
  json["measured"] = c.measured;
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
  json["confounded"] = e.identifiability.confounded;
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
  const Json json{{"verdict", c.verdict},
                  {"use", c.usable},
                  {"before", json_of(c.before)},
                  {"after", json_of(c.after)},
                  {"rank", c.estimate.identifiability.rank},
                  {"outliers", c.estimate.outliers.size()},
                  {"model", c.model_selection.selected},
                  {"predicted_error", c.estimate.predicted_error}};
  return json.dump() + "\n";
}

}  // namespace kinfer
