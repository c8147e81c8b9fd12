// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/calibrate/sections.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/report/calibrate/figures.hpp"
#include "kinfer/report/parts/shared_sections.hpp"
#include "kinfer/report/parts/units.hpp"

namespace kinfer::report {
namespace {

using html::Cell;

/// What an error table shows: positions in mm or orientations in degrees.
struct ErrorTable {
  const char* name;
  std::string caption;
  TrainHoldout ChainFit::*errors;
  double factor;
};

std::vector<Cell> error_row(const std::string& name, const ErrorStatistics& s, double factor) {
  constexpr int decimals = 4;
  return {html::text(name),
          html::number(s.mean, factor, decimals),
          html::number(s.rms, factor, decimals),
          html::number(s.sd, factor, decimals),
          html::number(s.max, factor, decimals),
          html::number(s.n, 0)};
}

std::string error_table(const CalibrationEvidence& e, const ErrorTable& shown) {
  html::Table table{.name = shown.name,
                    .caption = shown.caption,
                    .head = {"Model, rows", "mean", "rms", "sd", "max", "n"},
                    .rows = {}};
  const auto add = [&](const ChainFit& fit, ErrorStatistics TrainHoldout::*side, const std::string& words) {
    const ErrorStatistics& statistics = fit.*shown.errors.*side;
    if (statistics.n > 0) table.rows.push_back(error_row(words, statistics, shown.factor));
  };
  add(e.nominal, &TrainHoldout::holdout, "as given, not fitted");
  add(e.nominal, &TrainHoldout::train, "as given, all rows");
  add(e.before, &TrainHoldout::holdout, "base and tool fitted, rows not fitted");
  add(e.before, &TrainHoldout::train, "base and tool fitted, rows fitted");
  add(e.after, &TrainHoldout::holdout, "calibrated, rows not fitted");
  if (!e.gross_error_rows.empty()) add(e.after, &TrainHoldout::holdout_all_rows, "the same with gross errors");
  add(e.after, &TrainHoldout::train, "calibrated, rows fitted");
  return html::table(table);
}

struct DisplayUnit {
  double factor;
  const char* name;
  int decimals;
};
DisplayUnit display_unit(Quantity quantity) {
  if (quantity == Quantity::length) return {mm, "mm", 4};
  if (quantity == Quantity::angle) return {1.0 / degree, "°", 5};
  return {1.0, unit(quantity).data(), 8};
}

/// The base and its mountings are the robot's placement, no error of the robot.
bool is_placement(const ParameterEstimate& parameter) {
  return parameter.name.starts_with("base_");
}

Cell state_of(const ParameterEstimate& parameter) {
  if (!parameter.identifiable) return html::undetermined_cell("not determined");
  return html::text(is_placement(parameter) ? "placement" : "");
}

std::vector<Cell> parameter_row(const ParameterEstimate& p) {
  const DisplayUnit shown = display_unit(p.quantity);
  const double change = p.value - p.nominal;
  return {{fmt::format("<b>{}</b>", html::escape(p.name)), p.name, html::CellKind::name},
          html::number(p.nominal, shown.factor, shown.decimals),
          html::number(p.value, shown.factor, shown.decimals),
          html::number(change, shown.factor, shown.decimals),
          html::number(p.sd, shown.factor, shown.decimals),
          html::text(shown.name),
          html::number(p.sd > 0 ? change / p.sd : NAN, 1),
          state_of(p)};
}

std::string parameter_table(const CalibrationEvidence& e) {
  html::Table table{.name = "parameters",
                    .caption = "Parameters of the model: nominal, corrected, change ± one standard deviation",
                    .head = {"Parameter", "nominal", "corrected", "change", "±", "unit", "change / ±", ""},
                    .rows = {},
                    .long_after = 60};
  for (const ParameterEstimate& parameter : e.parameters) table.rows.push_back(parameter_row(parameter));
  return html::table(table);
}

std::string confounded_list(const CalibrationEvidence& e) {
  std::vector<std::string> items;
  for (const std::string& group : e.undetermined) items.push_back(html::escape(group));
  return items.empty() ? "<p>The data determine every combination of parameters.</p>"
                       : "<h3>Undetermined combinations of parameters</h3>" + html::list(items, "open");
}

std::vector<Cell> model_row(const ModelRecord& model) {
  const auto figure = [&](double value) { return html::number(model.skipped ? NAN : value, mm, 4); };
  const std::string description =
      model.description.empty() ? "" : "<br><small>" + html::escape(model.description) + "</small>";
  return {{fmt::format("<b>{}</b>{}", html::escape(model.name), description), model.name},
          figure(model.train.mean),
          figure(model.holdout.mean),
          figure(model.holdout.max),
          html::text(model.selected  ? "selected"
                     : model.skipped ? "not tested"
                                     : ""),
          html::text(model.reason)};
}

std::string outlier_table(const CalibrationEvidence& e) {
  html::Table table{.name = "outliers",
                    .caption = "Rejected measurements (outliers)",
                    .head = {"row (from 0)", "line of the file", "why"},
                    .rows = {}};
  for (const auto& [outlier, reason] : e.outliers)
    table.rows.push_back({html::number(outlier.row, 0), html::number(outlier.line, 0), html::text(reason)});
  return table.rows.empty() ? "<p>Every row is an inlier.</p>" : html::table(table);
}

std::string start_table(const SearchSummary& search) {
  html::Table table{.name = "starts",
                    .caption = "The same problem with several initial swarms",
                    .head = {"start", "iterations to the optimum", "evaluations", "rms at the end [mm]"},
                    .rows = {}};
  for (const SearchRun& run : search.swarm_comparison)
    table.rows.push_back({html::text(name(run.initial)),
                          run.iterations < 0 ? html::text("not reached") : html::number(run.iterations, 0),
                          html::number(run.evaluations, 0), html::number(run.rms, mm, 5)});
  return table.rows.empty() ? "" : html::table(table);
}

}  // namespace

html::Section errors_section(const CalibrationEvidence& e) {
  const bool has_angles = e.after.orientation.train.n > 0;
  std::string tables;
  if (e.after.position.train.n > 0 || !has_angles)
    tables += error_table(e, {"errors", fmt::format("Error of {} [mm]", headline(e).what), &ChainFit::position, mm});
  if (has_angles)
    tables += error_table(e, {"orientation-errors", fmt::format("Error of {} [°]", measured_angle(e)),
                              &ChainFit::orientation, 1.0 / degree});
  return {
      "errors", "How good it is",
      fmt::format("Held-out rows: {}. Trust the figures on rows that were not fitted.", html::escape(e.holdout)),
      "<div class=\"two\">" +
          html::figure("histogram", "Errors before and after", error_histogram(e),
                       "Number of poses by error. Where rows were held out, the error of every pose is that of a fit "
                       "without it. The last bar includes all larger errors.") +
          "<div>" + tables + "</div></div>" +
          html::figure("per-pose", "Pose by pose", errors_per_pose(e),
                       "In the order of the file, so that a drift or a change of the set-up would show. Choose a "
                       "dot to see the pose in the machine above.")};
}

html::Section parameters_section(const CalibrationEvidence& e) {
  return {"parameters-section", "What was corrected",
          "The parameters in <code>chain.toml</code>. A change of many times its ± is significant; a parameter that is "
          "<i>not determined</i> by these poses stayed close to its nominal value; <i>placement</i> is where the robot "
          "stands in the instrument's frame, no error of the robot.",
          parameter_table(e)};
}

html::Section uncertainty_section(const CalibrationEvidence& e) {
  std::string body =
      html::figure("workspace", "Where the model is uncertain", workspace_map(e),
                   "Expected error of the corrected model (without the instrument's noise) at joint positions evenly "
                   "distributed "
                   "over the ranges of the data. It does not hold far outside of the measured poses.") +
      "<div class=\"two\">" +
      html::figure(
          "singular", "Identifiability", singular_value_plot(e),
          "Each dot is one independent combination of parameters, in units of noise and tolerance. Above the line the "
          "data determine it better than the tolerances do; below, the nominal value is kept.") +
      "<div>" + confounded_list(e) + "</div></div>";
  if (const std::string map = correlation_map(e); !map.empty())
    body += "<details><summary>Correlation of the parameters</summary>" +
            html::figure("correlation", "Correlation", map,
                         "Strong colours: two parameters with correlated errors, of which only a combination is well "
                         "determined. This is normal, and harmless for the tool's position near the measured poses.") +
            "</details>";
  return {"uncertainty", "What is uncertain", "How far to trust the corrected model, and where.", body};
}

html::Section model_section(const CalibrationEvidence& e) {
  html::Table table{.name = "model",
                    .caption = "Tested models; error [mm]",
                    .head = {"Model", "mean, fitted", "mean, not fitted", "worst, not fitted", "", "Why"},
                    .rows = {}};
  for (const ModelRecord& model : e.model.models) table.rows.push_back(model_row(model));
  return {
      "model-section", "Model selection",
      "All terms are weighed together by the marginal likelihood of the data; the errors are those of the model with "
      "the terms up to each row. A term that the data support is refused only if held-out errors are worse with it.",
      model_selection_plot(e) + html::table(table)};
}

html::Section doubts_section(const CalibrationEvidence& e) {
  return {"doubts", "Outliers and findings", "Rows and measurements that do not fit, and what was done about them.",
          outlier_table(e) + findings_table(e.findings, FindingRows::shown) + notes_list(e.notes)};
}

html::Section search_section(const CalibrationEvidence& e) {
  const SearchSummary& s = e.search.summary;
  std::string body = fmt::format("<p>{}: {} iterations, {} evaluations, {}.</p>", html::escape(name(s.method)),
                                 s.iterations, s.evaluations, html::escape(e.search.stop_sentence));
  if (s.median.size() > 1)
    body +=
        html::figure("convergence", "Convergence", convergence_plot(s.best, s.median, "the search"),
                     "<i class=\"key after\"></i> best of the population, <i class=\"key before\"></i> its median.");
  return {"search", "How it was found", "The optimiser and its convergence.", body + start_table(s)};
}

}  // namespace kinfer::report
