// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/calibration_outliers.hpp"
#include "kinfer/base/constants.hpp"

#include <algorithm>

#include "kinfer/base/angle.hpp"
#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

constexpr double gravity = standard_gravity;  // [m/s²], to show a tilt residual as an angle

std::string residual_sentence(const OutlierReason& reason) {
  const double mm = 1e3 * reason.residual;
  switch (reason.kind) {
    case MeasurementKind::point:
      return phrase("point", "the point lies {:.3f} mm from where the model has it", mm);
    case MeasurementKind::orientation:
      return phrase("orientation", "the orientation is {:.3f} deg from what the model has", reason.residual / degree);
    case MeasurementKind::contact:
      return phrase("contact", "the tool point lies {:.3f} mm from its socket", mm);
    case MeasurementKind::distance:
      return phrase("distance", "the wire is {:.3f} mm longer or shorter than the model has it", mm);
    case MeasurementKind::pair:
      return phrase("pair", "the two tool points are {:.3f} mm nearer or further apart than the model has them", mm);
    case MeasurementKind::plane:
      return phrase("plane", "the tool point lies {:.3f} mm off its plane", mm);
    case MeasurementKind::tilt:
      return phrase("tilt", "the tilt is {:.3f} deg from what the model has", reason.residual / gravity / degree);
  }
  return "";
}

std::string list_of(const std::vector<std::string>& names) {
  std::string text = names.front();
  for (std::size_t i = 1; i < names.size(); ++i) text += (i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

}  // namespace

std::string measured_quantity(MeasurementKind kind) {
  switch (kind) {
    case MeasurementKind::contact:
      return "ball in socket";
    case MeasurementKind::distance:
      return "distance";
    case MeasurementKind::pair:
      return "ball-bar length";
    case MeasurementKind::plane:
      return "distance from the plane";
    case MeasurementKind::point:
      return "position";
    case MeasurementKind::orientation:
    case MeasurementKind::tilt:
      break;
  }
  return "orientation";
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
