// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/identification/verdict.hpp"

#include <algorithm>
#include <iterator>
#include <map>

#include "kinfer/words/findings/findings.hpp"
#include "kinfer/words/identification/forecast.hpp"
#include "kinfer/words/identification/joint_verdict.hpp"
#include "kinfer/words/identification/update.hpp"
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

std::string joints_text(const Identification& result) {
  const auto rigid = std::ranges::count(result.joints, EstimatedJointType::rigid, &JointEstimate::type);
  const std::string rigid_text = rigid > 0 ? fmt::format(", {} of them never moved", rigid) : "";
  const char* noun = result.joints.size() == 1 ? "joint" : "joints";
  if (result.forecast.empty() && result.usability == Usability::do_not_use)
    return phrase("joints_without_accuracy", "{} {} found{}", result.joints.size(), noun, rigid_text);
  const std::string accuracy = accuracy_text(result.forecast);
  return phrase("joints_found", "{} {} found{}{}, {}", result.joints.size(), noun, rigid_text,
                accuracy.empty() ? "" : ", their axes to " + accuracy, forecast_text(result.forecast, result.target));
}

/// What the search of all structures says about the chain that is written.
std::string certificate_text(const std::vector<LinkEvidence>& searches) {
  double excess = 0.0;
  for (const LinkEvidence& search : searches)
    if (search.written_holdout && search.holdout.total > 0.0)
      excess = std::max(excess, search.written_holdout->total / search.holdout.total - 1.0);
  if (std::ranges::none_of(searches, [](const LinkEvidence& search) { return search.written_holdout.has_value(); }))
    return phrase("best_chain", "no chain of up to 3 leaves fits better");  // the written chain is the search's
  if (excess < 0.005)
    return phrase("best_chain",
                  "no chain of up to 3 leaves a link predicts the held-out rows better than the one written");
  return phrase(
      "nearly_best_chain",
      "no chain of up to 3 leaves a link predicts the held-out rows by more than {:.0f} % better than the one "
      "written",
      100.0 * excess);
}

std::string recommendation_text(Usability usability) {
  switch (usability) {
    case Usability::use:
      return "Use it";
    case Usability::use_with_care:
      return "Use with care";
    case Usability::do_not_use:
      break;
  }
  return "Do not use as it is";
}

/// Of each kind the first few; the list of findings holds all.
std::vector<std::string> warnings(const std::vector<Finding>& findings) {
  constexpr int most = 3;
  std::vector<std::string> texts;
  std::map<FindingKind, std::pair<int, std::size_t>> of_kind;  // how many, and the text of the last that is listed
  for (const Finding& finding : findings) {
    if (finding.severity == Severity::note || invalidates_result(finding)) continue;
    auto& [count, text] = of_kind[finding.kind];
    if (++count > most) continue;
    text = texts.size();
    texts.push_back(words::sentence(finding));
  }
  for (const auto& [kind, listed] : of_kind)
    if (listed.first > most) texts[listed.second] += fmt::format(", and {} more findings like it", listed.first - most);
  return texts;
}

/// Faults first, then joints and accuracy, then what else is wrong with the recording.
VerdictText parts_of_verdict(const Identification& result) {
  std::vector<std::string> texts;
  for (const Finding& finding : result.findings)
    if (invalidates_result(finding)) texts.push_back(words::sentence(finding));
  std::ranges::move(refused_joint_sentences(result), std::back_inserter(texts));
  if (result.usability == Usability::do_not_use && texts.empty())
    texts.push_back(is_one_body(result.joints)
                        ? phrase("one_body",
                                 "no sensor certainly moves relative to another: all of them on one body, or every "
                                 "joint must be moved, each for some seconds")
                        : phrase("no_certain_joint", "no joint is certain"));
  if (const std::string part = usable_part_sentence(result); !part.empty() && !texts.empty()) texts.push_back(part);
  texts.push_back(joints_text(result));
  if (const std::string types = uncertain_types_sentence(result); !types.empty()) texts.push_back(types);
  if (result.update) texts.push_back(update_sentence(*result.update));
  texts.push_back(prediction_text(result.prediction));
  if (result.search_method == LinkSearchMethod::enumeration) texts.push_back(certificate_text(result.searches));
  std::ranges::move(warnings(result.findings), std::back_inserter(texts));
  VerdictText text{phrase(name(result.usability), "{}", recommendation_text(result.usability)), texts.front(), {}};
  text.remarks.assign(texts.begin() + 1, texts.end());
  return text;
}

}  // namespace

VerdictText identification_verdict_text(const Identification& result) {
  return parts_of_verdict(result);
}

std::string identification_verdict(const Identification& result) {
  if (language() == Language::names) return std::string(name(result.usability));
  return sentence(parts_of_verdict(result));
}

}  // namespace kinfer::words
