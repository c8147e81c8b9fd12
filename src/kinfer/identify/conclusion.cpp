#include "kinfer/identify/conclusion.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kinfer/identify/forecast.hpp"

namespace kinfer {
namespace {

/// [m/s²] rms of the worst sensor, in the rows that were fitted or held out.
double largest_misfit(const Identification& result, double Trace::*rms) {
  double largest = 0.0;
  for (const Trace& trace : result.motion.traces)
    if (trace.quantity == "acceleration") largest = std::max(largest, trace.*rms);
  return largest;
}

/// "accelerations in 11.0 s that it was not fitted to": what nobody has seen counts, where there is any.
std::string misfit_in_words(const Identification& result) {
  double seconds = 0.0;
  for (const TimeWindow& window : result.motion.held_out) seconds += window.end - window.begin;
  if (seconds <= 0.0)
    return fmt::format("accelerations are predicted to {:.3f} m/s² rms at worst",
                       largest_misfit(result, &Trace::rms_fitted));
  return fmt::format("accelerations in {:.1f} s that it was not fitted to are predicted to {:.3f} m/s² rms at worst",
                     seconds, largest_misfit(result, &Trace::rms_holdout));
}

std::string chain_in_words(const Identification& result) {
  const auto rigid = std::ranges::count(result.joints, FoundJointType::rigid, &FoundJoint::type);
  const std::string unmoved = rigid > 0 ? fmt::format(", {} of them never moved", rigid) : "";
  const char* certificate = result.engine == "enum" ? "; no chain of up to 3 leaves fits better" : "";
  const std::string accuracy = accuracy_in_words(result.forecast);
  return fmt::format("{} joints found{}{}, {}; {}{}", result.joints.size(), unmoved,
                     accuracy.empty() ? "" : ", their axes to " + accuracy, in_words(result.forecast),
                     misfit_in_words(result), certificate);
}

bool spoils(const Finding& finding) {
  return finding.severity == Severity::fault && !finding.applied;
}

/// Sentences of the findings that `pick` picks, each after a separator.
template <class Pick>
std::string sentences(const std::vector<Finding>& findings, const Pick& pick) {
  std::string text;
  for (const Finding& finding : findings)
    if (pick(finding)) text += "; " + finding.sentence;
  return text;
}

}  // namespace

void conclude(Identification& result) {
  for (const Finding& finding : result.findings)
    result.notes.push_back(finding.suggestion.empty() ? finding.sentence
                                                      : finding.sentence + ": " + finding.suggestion);
  result.use = std::ranges::none_of(result.findings, spoils);
  const std::string faults = sentences(result.findings, spoils);
  const std::string rest =
      sentences(result.findings, [](const Finding& f) { return f.severity != Severity::note && !spoils(f); });
  const std::string judgement = !result.use ? fmt::format("Do not use as it is: {}; ", faults.substr(2))
                                : enough_for_all(result.forecast) ? "Use it: "
                                                                  : "Use with care: ";
  result.verdict = judgement + chain_in_words(result) + rest;
}

}  // namespace kinfer
