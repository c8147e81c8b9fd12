#include "kinfer/identify/conclusion.hpp"

#include <fmt/ranges.h>

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

/// "…, and to 0.035 in 10.6 s that it was not fitted to"
std::string held_out_in_words(const Identification& result) {
  double seconds = 0.0;
  for (const TimeWindow& window : result.motion.held_out) seconds += window.end - window.begin;
  if (seconds <= 0.0) return "";
  return fmt::format(", and to {:.3f} in {:.1f} s that it was not fitted to",
                     largest_misfit(result, &Trace::rms_holdout), seconds);
}

std::string chain_in_words(const Identification& result) {
  std::vector<std::string> chain;
  for (const FoundJoint& joint : result.joints) chain.push_back(fmt::format("{}-{}", joint.parent, joint.child));
  const auto rigid = std::ranges::count(result.joints, FoundJointType::rigid, &FoundJoint::type);
  const std::string unmoved = rigid > 0 ? fmt::format(", {} of them never moved", rigid) : "";
  const char* certificate = result.engine == "enum" ? "; no chain of up to 3 leaves fits better" : "";
  return fmt::format("{} joints found{} ({}); the chain predicts accelerations to {:.3f} m/s² rms at worst{}; {}{}",
                     result.joints.size(), unmoved, fmt::join(chain, ", "), largest_misfit(result, &Trace::rms_fitted),
                     held_out_in_words(result), in_words(result.forecast), certificate);
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
  result.verdict =
      (result.use ? "" : fmt::format("do not use as it is: {}; ", faults.substr(2))) + chain_in_words(result) + rest;
}

}  // namespace kinfer
