// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/identification_verdict.hpp"

#include <algorithm>

#include "kinfer/words/findings.hpp"
#include "kinfer/words/identification_forecast.hpp"
#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

std::string prediction_text(const PredictionSummary& prediction) {
  if (prediction.held_out_seconds <= 0.0)
    return phrase("fitted_prediction", "accelerations are predicted to {:.3f} m/s² rms at worst",
                  prediction.worst_acceleration);
  return phrase("held_out_prediction",
                "accelerations in {:.1f} s that it was not fitted to are predicted to {:.3f} m/s² rms at worst",
                prediction.held_out_seconds, prediction.worst_acceleration);
}

std::string chain_text(const Identification& result) {
  const auto rigid = std::ranges::count(result.joints, EstimatedJointType::rigid, &JointEstimate::type);
  const std::string rigid_text = rigid > 0 ? fmt::format(", {} of them never moved", rigid) : "";
  const char* certificate =
      result.search_method == LinkSearchMethod::enumeration ? "; no chain of up to 3 leaves fits better" : "";
  const std::string accuracy = accuracy_text(result.forecast);
  return fmt::format("{} joints found{}{}, {}; {}{}", result.joints.size(), rigid_text,
                     accuracy.empty() ? "" : ", their axes to " + accuracy,
                     forecast_text(result.forecast, result.target), prediction_text(result.prediction), certificate);
}

/// Sentences of the findings for which `pick` is true, each after a separator.
template <class Pick>
std::string joined_sentences(const std::vector<Finding>& findings, const Pick& pick) {
  std::string text;
  for (const Finding& finding : findings)
    if (pick(finding)) text += "; " + words::sentence(finding);
  return text;
}

std::string recommendation_text(const Identification& result) {
  switch (result.usability) {
    case Usability::use:
      return "Use it: ";
    case Usability::use_with_care:
      return "Use with care: ";
    case Usability::do_not_use:
      break;
  }
  const std::string faults = joined_sentences(result.findings, invalidates_result);
  return fmt::format("Do not use as it is: {}; ", faults.substr(std::min<std::size_t>(2, faults.size())));
}

}  // namespace

std::string identification_verdict(const Identification& result) {
  const std::string others = joined_sentences(
      result.findings, [](const Finding& f) { return f.severity != Severity::note && !invalidates_result(f); });
  return phrase(name(result.usability), "{}{}{}", recommendation_text(result), chain_text(result), others);
}

}  // namespace kinfer::words
