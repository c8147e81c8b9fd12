// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/calibration/model_selection.hpp"

#include <algorithm>
#include <array>

namespace kinfer {
namespace {

// In the order of the enumerators.
constexpr std::array<std::string_view, term_count> names_of_terms{
    "gains", "coupling", "gravity", "torques", "gear", "spectrum", "backlash", "temperature", "field"};
constexpr std::array<std::string_view, 10> decision_names{
    "start",       "accepted",     "requested", "no_evidence", "no_improvement", "tail_rises", "extrapolation_worse",
    "not_excited", "data_missing", "superseded"};
constexpr std::array<std::string_view, 8> missing_names{
    "none", "gravity", "torques", "approach_order", "temperature", "temperature_range", "spectral_line", "points"};

}  // namespace

std::string_view name(Term term) {
  return names_of_terms[static_cast<std::size_t>(term)];
}

std::optional<Term> term_named(std::string_view name) {
  const auto at = std::ranges::find(names_of_terms, name);
  if (at == names_of_terms.end()) return std::nullopt;
  return static_cast<Term>(at - names_of_terms.begin());
}

std::vector<std::string> term_names() {
  return {names_of_terms.begin(), names_of_terms.end()};
}

std::string_view name(Decision decision) {
  return decision_names[static_cast<std::size_t>(decision)];
}

std::string_view name(MissingData missing) {
  return missing_names[static_cast<std::size_t>(missing)];
}

std::string_view name(const SelectionStep& step) {
  return step.term ? name(*step.term) : "geometry";
}

bool is_selected(const SelectionStep& step) {
  return step.decision == Decision::start || step.decision == Decision::accepted ||
         step.decision == Decision::requested;
}

bool was_tested(const SelectionStep& step) {
  return step.decision != Decision::not_excited && step.decision != Decision::data_missing &&
         step.decision != Decision::superseded;
}

std::vector<Term> selected_terms(const ModelSelection& selection) {
  std::vector<Term> terms;
  for (const SelectionStep& step : selection.steps)
    if (step.term && is_selected(step)) terms.push_back(*step.term);
  return terms;
}

std::string selected_model(const ModelSelection& selection) {
  std::string text = selection.steps.empty() ? "" : "geometry";
  for (const Term term : selected_terms(selection)) text += " + " + std::string(name(term));
  return text;
}

}  // namespace kinfer
