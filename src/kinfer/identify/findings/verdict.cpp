// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/findings/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kinfer/identify/findings/forecast.hpp"

namespace kinfer::identify {
namespace {

/// [m/s²] acceleration residual of the worst sensor, rms over the fitted or the held-out rows.
double largest_misfit(const Identification& result, double Trace::*rms) {
  double largest = 0.0;
  for (const Trace& trace : result.motion.traces)
    if (trace.quantity == "acceleration") largest = std::max(largest, trace.*rms);
  return largest;
}

/// "accelerations in 11.0 s that it was not fitted to ...": held-out windows if there are any, else the fitted rows.
std::string prediction_sentence(const Identification& result) {
  double seconds = 0.0;
  for (const TimeWindow& window : result.motion.held_out) seconds += window.end - window.begin;
  if (seconds <= 0.0)
    return fmt::format("accelerations are predicted to {:.3f} m/s² rms at worst",
                       largest_misfit(result, &Trace::rms_fitted));
  return fmt::format("accelerations in {:.1f} s that it was not fitted to are predicted to {:.3f} m/s² rms at worst",
                     seconds, largest_misfit(result, &Trace::rms_holdout));
}

std::string chain_sentence(const Identification& result) {
  const auto rigid = std::ranges::count(result.joints, EstimatedJointType::rigid, &JointEstimate::type);
  const std::string rigid_text = rigid > 0 ? fmt::format(", {} of them never moved", rigid) : "";
  const char* certificate = result.engine == "enum" ? "; no chain of up to 3 leaves fits better" : "";
  const std::string accuracy = accuracy_text(result.forecast);
  return fmt::format("{} joints found{}{}, {}; {}{}", result.joints.size(), rigid_text,
                     accuracy.empty() ? "" : ", their axes to " + accuracy, forecast_text(result.forecast),
                     prediction_sentence(result), certificate);
}

bool invalidates(const Finding& finding) {
  return finding.severity == Severity::fault && !finding.applied;
}

/// Sentences of the findings for which `pick` is true, each after a separator.
template <class Pick>
std::string sentences(const std::vector<Finding>& findings, const Pick& pick) {
  std::string text;
  for (const Finding& finding : findings)
    if (pick(finding)) text += "; " + finding.sentence;
  return text;
}

}  // namespace

void set_verdict(Identification& result) {
  for (const Finding& finding : result.findings)
    result.notes.push_back(finding.suggestion.empty() ? finding.sentence
                                                      : finding.sentence + ": " + finding.suggestion);
  result.use = std::ranges::none_of(result.findings, invalidates);
  const std::string faults = sentences(result.findings, invalidates);
  const std::string rest =
      sentences(result.findings, [](const Finding& f) { return f.severity != Severity::note && !invalidates(f); });
  const std::string recommendation = !result.use ? fmt::format("Do not use as it is: {}; ", faults.substr(2))
                                     : all_sufficient(result.forecast) ? "Use it: "
                                                                       : "Use with care: ";
  result.verdict = recommendation + chain_sentence(result) + rest;
}

}  // namespace kinfer::identify
