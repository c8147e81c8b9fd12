// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/findings/outliers.hpp"

#include <algorithm>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/constants.hpp"
#include "kinfer/measurement/measurements.hpp"
#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

constexpr double gravity = standard_gravity;  // [m/s²], to show a tilt residual as an angle

/// The residual as a screen shows it.
std::string shown(double residual, ResidualUnit unit) {
  switch (unit) {
    case ResidualUnit::length:
      return fmt::format("{:.3f} mm", 1e3 * residual);
    case ResidualUnit::angle:
      return fmt::format("{:.3f} deg", residual / degree);
    case ResidualUnit::acceleration:
      return fmt::format("{:.3f} deg", residual / gravity / degree);
  }
  return "";
}

std::string residual_sentence(const OutlierReason& reason) {
  const MeasurementTraits& kind = traits_of(reason.kind);
  const std::string error = shown(reason.residual, kind.unit);
  if (reason.kind == kind_of<PointMeasurement>)
    return phrase(kind.name, "the point lies {} from where the model has it", error);
  if (reason.kind == kind_of<SocketContact>) return phrase(kind.name, "the tool point lies {} from its socket", error);
  if (reason.kind == kind_of<DistanceMeasurement>)
    return phrase(kind.name, "the wire is {} longer or shorter than the model has it", error);
  if (reason.kind == kind_of<PairDistance>)
    return phrase(kind.name, "the two tool points are {} nearer or further apart than the model has them", error);
  if (reason.kind == kind_of<PlaneContact>) return phrase(kind.name, "the tool point lies {} off its plane", error);
  return phrase(kind.name, "the {} is {} from what the model has", kind.quantity, error);
}

std::string list_of(const std::vector<std::string>& names) {
  std::string text = names.front();
  for (std::size_t i = 1; i < names.size(); ++i) text += (i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

}  // namespace

std::string measured_quantity(MeasurementKind kind) {
  return std::string(traits_of(kind).quantity);
}

std::string measured_kinds() {
  std::vector<std::string> plurals;
  for (std::size_t kind = 0; kind < measurement_kinds; ++kind)
    plurals.emplace_back(traits_of(static_cast<MeasurementKind>(kind)).plural);
  return list_of(plurals);
}

std::string outlier_reasons(const std::vector<OutlierReason>& reasons) {
  std::string text;
  for (const OutlierReason& reason : reasons)
    text += fmt::format("{}{} ({:.0f} sigma)", text.empty() ? "" : "; ", residual_sentence(reason), reason.sigmas);
  return text;
}

std::string sentence(const Outlier& outlier) {
  return (outlier.held_out ? "held out: " : "") + outlier_reasons(outlier.reasons);
}

std::string sentence(const UndeterminedGroup& group) {
  switch (group.reason) {
    case Undetermined::no_effect:
      return phrase(name(group.reason), "{} has no effect that these measurements could show",
                    list_of(group.parameters));
    case Undetermined::weaker_than_tolerance:
      return phrase(name(group.reason), "{} is not known better than its tolerance from these poses",
                    list_of(group.parameters));
    case Undetermined::confounded:
      return phrase(name(group.reason), "{} cannot be told apart from these poses", list_of(group.parameters));
  }
  return "";
}

std::vector<std::string> undetermined_sentences(const Identifiability& identifiability) {
  std::vector<std::string> list;
  for (const UndeterminedGroup& group : identifiability.undetermined) list.push_back(sentence(group));
  std::sort(list.begin(), list.end());
  return list;
}

}  // namespace kinfer::words
