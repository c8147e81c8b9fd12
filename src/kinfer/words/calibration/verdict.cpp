// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "kinfer/words/calibration/calibration.hpp"
#include "kinfer/words/findings/findings.hpp"
#include "kinfer/words/findings/outliers.hpp"
#include "kinfer/words/findings/row_ranges.hpp"
#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

constexpr double normal_limit = 1.96;  // [sd] 95 % of a normal distribution

std::string millimetres(double metres) {
  return fmt::format("{:.3f} mm", 1e3 * metres);
}
std::string degrees(double radians) {
  return fmt::format("{:.3f} deg", radians / degree);
}

std::string rejected_rows(std::size_t n) {
  return n == 1 ? "1 row is rejected as an outlier" : fmt::format("{} rows are rejected as outliers", n);
}

/// Which rows are excluded from the figures, the worst error with them, and how many more rows the fit gives no weight.
std::vector<std::string> excluded_rows_texts(const Calibration& c, const std::string& worst_of_all) {
  const std::size_t listed = c.estimate.outliers.size(), wrong = c.gross_error_rows.size();
  if (wrong == 0 && listed == 0) return {};
  if (wrong == 0) return {phrase("rows_without_weight", "{}", rejected_rows(listed))};
  std::vector<std::string> texts{phrase("rows_excluded", "{}: {} ({} at worst with {})", rejected_rows(wrong),
                                        row_ranges(c.gross_error_rows), worst_of_all, wrong == 1 ? "it" : "them")};
  const std::size_t more = listed - wrong;
  if (more > 0)
    texts.push_back(phrase("rows_without_weight", "the fit gives {} more row{} no weight", more, more == 1 ? "" : "s"));
  return texts;
}

/// "the tool" for positions; other measurements by their own name.
std::string subject(const Calibration& c) {
  return c.measured == kind_of<PointMeasurement> ? "the tool is"
                                                 : fmt::format("the {} is", measured_quantity(c.measured));
}

auto display_of(const Calibration& c) {
  return has_lengths(c) ? millimetres : degrees;
}

std::string figures_beside_nominal(const Calibration& c) {
  const auto show = display_of(c);
  const ErrorStatistics &before = reported_errors(c, c.before), &after = reported_errors(c, c.after);
  return phrase("errors", "on poses that were not fitted {} {} off on average and {} at worst ({} and {} before)",
                subject(c), show(after.mean), show(after.max), show(before.mean), show(before.max));
}

std::string figures_without_nominal(const Calibration& c) {
  const ErrorStatistics &train = c.after.position.train, &holdout = c.after.position.holdout;
  return phrase(
      "errors",
      "on poses that were not fitted the tool is {} off on average and {} at worst, on fitted ones {} on average",
      millimetres(holdout.mean), millimetres(holdout.max), millimetres(train.mean));
}

std::string figures(const Calibration& c) {
  return c.unknown_robot ? figures_without_nominal(c) : figures_beside_nominal(c);
}

std::string unobserved_text(const UnobservedLengths& unobserved) {
  const double per_metre = 1e3 * unobserved.relative_sd;  // [mm] per metre
  return unobserved.kind == UnobservedLength::size
             ? phrase(name(unobserved.kind),
                      "the size of the robot is unobservable, since no length was measured: it rests on the tolerances "
                      "of the lengths and may be {:.2f} mm per metre off (95 %)",
                      normal_limit * per_metre)
             : phrase(
                   name(unobserved.kind),
                   "lengths are unobservable, since nothing was measured but orientations, or contacts and sights by "
                   "which their own fixtures are placed and no more: they are the nominal ones, and the size may be "
                   "{:.2f} mm per metre off (95 %)",
                   normal_limit * per_metre);
}

std::vector<std::string> remarks(const Calibration& c) {
  const TrainHoldout& errors = has_lengths(c) ? c.after.position : c.after.orientation;
  std::vector<std::string> texts;
  if (c.unobserved_lengths) texts.push_back(unobserved_text(*c.unobserved_lengths));
  for (const std::string& text : excluded_rows_texts(c, display_of(c)(errors.holdout_all_rows.max)))
    texts.push_back(text);
  if (c.geometry_only)
    texts.push_back(phrase("geometry_only", "geometry alone: a swarm search has no model selection"));
  return texts;
}

/// The errors, by the prediction model where it has room for them, over those of instrument and fit.
double unexplained_ratio(const Calibration& c) {
  const double measured = reported_errors(c, c.after).rms;
  return std::max(measured, c.predicted_holdout_rms.value_or(0.0)) / *c.expected_holdout_rms;
}

/// Which kind the others contradict, and by how much.
std::string contradiction_text(const Calibration& c) {
  if (!c.contradiction) return "measurements that were fitted together contradict each other: ";
  const Contradiction& kind = *c.contradiction;
  const bool angle = traits_of(kind.kind).unit != ResidualUnit::length;
  const std::string noise =
      kind.noise > 0.0 ? fmt::format(", {:.0f} times their noise", kind.error / kind.noise) : std::string{};
  return fmt::format(
      "{} of {} {} contradict the other measurements: they are {} off{}, more than the robot's tolerances could make, "
      "so "
      "correct them or leave them out: ",
      kind.contradicted, kind.measured, traits_of(kind.kind).plural,
      angle ? degrees(kind.error) : millimetres(kind.error), noise);
}

/// The first fault that stands.
std::string fault_text(const Calibration& c) {
  const auto fault = std::ranges::find_if(c.findings, invalidates_result);
  return fault == c.findings.end() ? "a fault of the data stands" : words::sentence(*fault);
}

VerdictText with_remarks(const Calibration& c, const std::string& statement) {
  return {phrase(name(c.usability), "{}", verdict_headline(c)), phrase(name(c.reason), "{}", statement), remarks(c)};
}

VerdictText parts_of_verdict(const Calibration& c) {
  switch (c.reason) {
    case CalibrationReason::improves_nominal:
      return with_remarks(c, figures(c));
    case CalibrationReason::no_improvement:
      return with_remarks(c, "the corrected model is no better than the nominal one: " + figures(c));
    case CalibrationReason::unproven:
      return with_remarks(
          c, fmt::format("better, but these poses do not prove it: a model that is no better would look as good with a "
                         "probability of {:.0f} %: {}",
                         100.0 * c.chance_of_improvement.value_or(1.0), figures(c)));
    case CalibrationReason::beyond_tolerances:
      return with_remarks(c,
                          "better, but the errors that are left are more than the tolerances of the robot's model "
                          "could make, so joints and measurements do not belong together or the robot is another "
                          "one: " +
                              figures(c));
    case CalibrationReason::unexplained:
      return with_remarks(c,
                          "better, but the errors that are left are more than the tolerances of the robot's model "
                          "could make: unless the instrument is that inaccurate (state its sigma), joints and "
                          "measurements do not belong together: " +
                              figures(c));
    case CalibrationReason::fault_remains: {
      VerdictText text = with_remarks(c, fault_text(c));
      text.remarks.insert(text.remarks.begin(), figures(c));
      return text;
    }
    case CalibrationReason::far_from_nominal:
      return with_remarks(
          c, fmt::format("the robot is {:.0f} times further from its nominal model than the tolerances say, so perhaps "
                         "it is another one, or something is in other units: {}",
                         c.tolerance_factor, figures(c)));
    case CalibrationReason::beyond_noise:
      return with_remarks(
          c,
          fmt::format("better, but the errors are {:.0f} times what the instrument's noise explains, so something is "
                      "not modelled or not as stated: {}",
                      reported_errors(c, c.after).rms / c.noise_holdout_rms.value_or(1.0), figures(c)));
    case CalibrationReason::contradictory:
      return with_remarks(c, contradiction_text(c) + figures(c));
    case CalibrationReason::collapsed:
      return with_remarks(c,
                          "only a robot that does not move along a direction in which the nominal one does explains "
                          "these measurements, so joints and measurements do not belong together: " +
                              figures(c));
    case CalibrationReason::unchanged:
      return with_remarks(c, "these poses show no move of the joint offsets, so keep the earlier model: " + figures(c));
    case CalibrationReason::unmodelled_effects:
      return with_remarks(c, fmt::format("better, but the errors are {:.0f} times what instrument and fit explain, "
                                         "so something is not modelled: {}",
                                         unexplained_ratio(c), figures(c)));
    case CalibrationReason::not_validated: {
      VerdictText text = with_remarks(
          c, fmt::format("the fit of all rows is {:.1f} times worse on them than the fits that validate it are on rows "
                         "that they have not seen",
                         final_errors(c).rms / reported_errors(c, c.after).rms));
      text.remarks.insert(text.remarks.begin(), figures(c));
      return text;
    }
    case CalibrationReason::generalises:
    case CalibrationReason::overfitted:
      break;
  }
  return {phrase(name(c.usability), "{}", verdict_headline(c)),
          phrase(name(c.reason), "the robot was found without a data sheet"),
          {figures(c)}};
}

}  // namespace

std::string verdict_headline(const Calibration& calibration) {
  if (calibration.usability == Usability::use) return "Use it";
  if (calibration.usability == Usability::use_with_care) return "Use with care";
  return calibration.reason == CalibrationReason::unmodelled_effects ? "Do not use without a look" : "Do not use";
}

VerdictText verdict_text(const Calibration& c) {
  return parts_of_verdict(c);
}

std::string verdict(const Calibration& c) {
  if (language() == Language::names) return std::string(name(c.reason));
  return kinfer::sentence(parts_of_verdict(c)) + ".";
}

}  // namespace kinfer::words
