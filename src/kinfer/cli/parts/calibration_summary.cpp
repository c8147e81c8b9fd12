// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/parts/calibration_summary.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kinfer/words/calibration/calibration.hpp"
#include "kinfer/words/calibration/model.hpp"
#include "kinfer/words/findings/outliers.hpp"
#include "kinfer/words/status.hpp"

namespace kinfer::cli {
namespace {

std::string table_row(const char* what, const ErrorStatistics& s, double scale) {
  return fmt::format("  {:<34} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>6}\n", what, scale * s.mean, scale * s.rms,
                     scale * s.sd, scale * s.max, s.n);
}

std::string fit_table(const std::string& title, const ChainFit& nominal, const ChainFit& before, const ChainFit& after,
                      TrainHoldout ChainFit::*kind, double scale) {
  std::string text = fmt::format("  {:<34} {:>9} {:>9} {:>9} {:>9} {:>6}\n", title, "mean", "rms", "sd", "max", "n");
  text += table_row("as nominal", (nominal.*kind).holdout, scale);
  text += table_row("base and tool refitted, not fitted", (before.*kind).holdout, scale);
  text += table_row("calibrated, not fitted", (after.*kind).holdout, scale);
  if (const ErrorStatistics& all = (after.*kind).holdout_all_rows; all.n > (after.*kind).holdout.n)
    text += table_row("  the same with the wrong rows", all, scale);
  text += table_row("calibrated, fitted", (after.*kind).train, scale);
  return text + "\n";
}

/// Display units: degrees and millimetres; other quantities unscaled.
struct Shown {
  double factor;
  const char* unit;
};
Shown shown(Quantity quantity) {
  switch (quantity) {
    case Quantity::length:
      return {1e3, "mm"};
    case Quantity::angle:
      return {1.0 / degree, "deg"};
    default:
      return {1.0, unit(quantity).data()};
  }
}

std::string parameter_table(const Estimate& estimate) {
  std::string text =
      fmt::format("  {:<14} {:>13} {:>13} {:>11} {:>10}\n", "parameter", "nominal", "error", "sd", "unit");
  for (const ParameterEstimate& p : estimate.values) {
    const auto [factor, unit_name] = shown(p.quantity);
    text += fmt::format("  {:<14} {:>13.4f} {:>+13.4f} {:>11.4f} {:>10}{}\n", p.name, factor * p.nominal,
                        factor * (p.value - p.nominal), factor * p.sd, unit_name,
                        p.identifiable ? "" : "   not determined");
  }
  return text + "\n";
}

template <class List, class Words>
std::string bullet_list(const char* title, const List& list, std::size_t most, Words words) {
  if (list.empty()) return "";
  std::string text = fmt::format("{}\n", title);
  for (std::size_t i = 0; i < std::min(most, list.size()); ++i) text += "  - " + words(list[i]) + "\n";
  if (list.size() > most) text += fmt::format("  - and {} more (evidence.json lists all)\n", list.size() - most);
  return text + "\n";
}

std::string model_table(const ModelSelection& selection) {
  if (selection.steps.size() < 2) return "";
  std::string text = fmt::format("Model: {}.\n  {:<14} {:>11} {:>11} {:>11}\n", selected_model(selection), "term [mm]",
                                 "fitted", "not fitted", "worst");
  for (const SelectionStep& step : selection.steps) {
    const std::string reason = words::reason(step);
    if (step.holdout.n > 0)
      text += fmt::format("  {:<14} {:>11.4f} {:>11.4f} {:>11.4f}   {}\n", name(step), 1e3 * step.train.mean,
                          1e3 * step.holdout.mean, 1e3 * step.holdout.max, reason);
    else
      text += fmt::format("  {:<14} {:>11} {:>11} {:>11}   {}\n", name(step), "-", "-", "-", reason);
  }
  return text + "\n";
}

std::string search_lines(const SearchSummary& search) {
  if (search.method == SearchMethod::levenberg_marquardt) return "";
  std::string text = fmt::format("Searched by {}: {} iterations, {} evaluations, {}.\n", name(search.method),
                                 search.iterations, search.evaluations, words::sentence(search.stop));
  if (search.swarm_comparison.empty()) return text + "\n";
  text += "Iterations to the least-squares optimum: ";
  for (const SearchRun& run : search.swarm_comparison)
    text += fmt::format("{}{} {}", &run == &search.swarm_comparison.front() ? "" : "; ", name(run.initial),
                        run.iterations < 0 ? "not reached" : fmt::format("{}", run.iterations));
  return text + ".\n\n";
}

std::string error_tables(const Calibration& c) {
  const bool has_angles = c.after.orientation.train.n > 0;
  std::string text;
  if (has_lengths(c) || !has_angles)
    text += fit_table(
        c.measured == kind_of<PointMeasurement> ? "tool position [mm]" : words::measured_quantity(c.measured) + " [mm]",
        c.nominal, c.before, c.after, &ChainFit::position, 1e3);
  if (has_angles)
    text += fit_table(c.measured == kind_of<TiltMeasurement> ? "tilt [deg]" : "tool orientation [deg]", c.nominal,
                      c.before, c.after, &ChainFit::orientation, 1.0 / degree);
  return text;
}

}  // namespace

std::string calibration_summary(const Calibration& c) {
  const Estimate& e = c.estimate;
  std::string text = words::verdict(c) + "\n\n";
  text += fmt::format("Held out: {}.\n", words::description(c.holdout));
  text += error_tables(c);
  text += model_table(c.model_selection);
  text += search_lines(e.search);
  text += parameter_table(e);
  text += fmt::format("The data determine {} of {} combinations of parameters. Noise level {:.4f} mm",
                      e.identifiability.rank, e.values.size(), 1e3 * e.sigma);
  text += e.chi2_per_n ? fmt::format("; chi2/n {:.2f} against the instrument (1 is good).\n", *e.chi2_per_n)
                       : " per axis, judged from the residuals.\n";
  text += fmt::format("Expected error of the corrected model itself: {:.4f} mm rms over these poses.\n\n",
                      1e3 * e.predicted_error);
  const auto same = [](const std::string& s) { return s; };
  text += bullet_list("Unobservable in these poses (held by the tolerances):",
                      words::undetermined_sentences(e.identifiability), 12, same);
  text += bullet_list("Outliers:", e.outliers, 12, [](const Outlier& o) {
    return fmt::format("row {} (line {}): {}", o.row, o.line, words::sentence(o));
  });
  text += bullet_list("Noticed:", words::notes(c), 20, same);
  return text;
}

std::string statistics_line(const ErrorStatistics& s) {
  return fmt::format("mean {:.4f}  rms {:.4f}  max {:.4f} mm over {}", 1e3 * s.mean, 1e3 * s.rms, 1e3 * s.max, s.n);
}

}  // namespace kinfer::cli
