// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/calibrate/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinfer/report/calibrate/figures.hpp"
#include "kinfer/report/calibrate/sections.hpp"
#include "kinfer/report/parts/shared_sections.hpp"
#include "kinfer/report/parts/units.hpp"
#include "kinfer/report/parts/verdict_block.hpp"

namespace kinfer::report {
namespace {

std::string in_mm(double metres) {
  return html::short_number(mm * metres) + " mm";
}

std::string plural(std::size_t n, std::string_view one) {
  return fmt::format("{} {}{}", n, one, n == 1 ? "" : "s");
}

std::string facts(const CalibrationEvidence& e) {
  return fmt::format(
      "<dl class=\"facts\"><dt>Poses</dt><dd>{}, of which {} with outliers</dd><dt>Validation</dt><dd>{}</dd>"
      "<dt>Model</dt><dd>{}, {} parameters</dd></dl>",
      e.rows.size(), e.outliers.size(), html::escape(e.holdout), html::escape(e.model.selected), e.parameters.size());
}

std::string first_screen(const CalibrationEvidence& e) {
  const Headline h = headline(e);
  const std::string name = html::escape(e.robot);
  return "<div class=\"say\">" + verdict_block(e.verdict, "Calibration of " + name) + gain_drawing(e) +
         fmt::format(
             "<p class=\"note\">Mean error of {} on {}: <b>{} times</b> smaller. <i>Before</i> is the data sheet's "
             "model after base and tool were fitted; the line marks the worst pose.</p>",
             html::escape(h.what),
             h.held_out ? "poses that were <b>not</b> used for the fit" : "the poses that were fitted",
             html::short_number(h.mean_before / std::max(1e-12, h.mean_after))) +
         facts(e) + "</div><div class=\"machine\" id=\"machine\"><div class=\"still\">" +
         calibrated_machine_drawing(e) + "</div></div>";
}

std::string how_good(const CalibrationEvidence& e) {
  const Headline h = headline(e);
  const double most = mm * error_percentile_95(e);
  std::string text = fmt::format(
      "<p><b class=\"big\">{}&nbsp;{}</b> on average, <b>{}&nbsp;{}</b> at worst{}.</p><p>Validated on {} "
      "measurements: "
      "{}.</p>",
      html::short_number(h.mean_after), h.unit, html::short_number(h.max_after), h.unit,
      std::isfinite(most) ? fmt::format("; 95 of 100 poses stay below <b>{}&nbsp;mm</b>", html::short_number(most))
                          : "",
      h.n, html::escape(e.holdout));
  if (e.chi2_per_n && std::isfinite(*e.chi2_per_n)) {
    const double times = std::sqrt(*e.chi2_per_n);
    text +=
        times < 1.5
            ? fmt::format("<p>The remaining errors are mostly the instrument's noise, {} per axis.</p>", in_mm(e.sigma))
            : fmt::format("<p>The remaining errors are {} times the instrument's noise: the model lacks an effect.</p>",
                          html::short_number(times));
  } else {
    text +=
        fmt::format("<p>No instrument was stated: its noise is estimated from the remaining errors, {} per axis.</p>",
                    in_mm(e.sigma));
  }
  return text;
}

std::string how_uncertain(const CalibrationEvidence& e) {
  const auto open = std::ranges::count(e.parameters, false, &ParameterEstimate::identifiable);
  std::string text = fmt::format(
      "<p><b class=\"big\">{}</b> is the expected error (rms) of the corrected model itself at the tool, over these "
      "poses. The errors above the cards include the instrument's noise.</p>",
      in_mm(e.predicted_error));
  text += open == 0
              ? std::string("<p>The data determine every parameter.</p>")
              : fmt::format(
                    "<p>{} of {} parameters are not determined by these poses and stay near their nominal values. This "
                    "does no harm near the measured poses; elsewhere see <a href=\"#uncertainty\">the map</a>.</p>",
                    open, e.parameters.size());
  if (const std::size_t wrong = e.outliers.size(); wrong > 0)
    text += fmt::format("<p><a href=\"#doubts\">{}</a> rejected as outliers.</p>",
                        wrong == 1 ? "One row was" : plural(wrong, "row") + " were");
  return text;
}

html::Section calibration_glossary() {
  return glossary_section({
      {"not fitted, held out",
       "Poses that were not used for the fit. Only their errors show how accurate the model is on a new pose."},
      {"cross-validation",
       "The poses are divided into parts; the errors of each part are those of a fit to the others."},
      {"base and tool", "Where the robot stands in the instrument's frame, and where the target sits on the flange."},
      {"a, alpha, d, theta, beta",
       "The five numbers from one joint axis to the next (Denavit and Hartenberg; beta is Hayati's rotation for nearly "
       "parallel axes). The number behind the letter is the joint's row, from 1."},
      {"gain, compliance", "Joint displacement per joint position; rotation per torque of gravity."},
      {"±, sd", "One standard deviation of the number."},
      {"not determined", "The data do not determine the parameter better than its tolerance does."},
      {"rms", "Root of the mean square: weighs large errors more than the mean does."},
  });
}

}  // namespace

Page calibration_page(const CalibrationEvidence& e) {
  std::vector<Advice> next;
  for (const CalibrationAdviceRecord& advice : e.next) next.push_back(advice.text);
  Page page{.title = "Calibration of " + e.robot, .first = first_screen(e), .sections = {}};
  page.first += cards({{"How good is it?", how_good(e)},
                       {"What is uncertain?", how_uncertain(e)},
                       {"What to do next?", advice_list(next, 3)}});
  page.sections = {errors_section(e), parameters_section(e), uncertainty_section(e), model_section(e),
                   doubts_section(e)};
  page.sections.push_back(search_section(e));
  page.sections.push_back(next_section(next));
  page.sections.push_back(calibration_glossary());
  page.sections.push_back(repeat_section(e.provenance));
  page.sections.push_back(notices_section());
  return page;
}

}  // namespace kinfer::report
