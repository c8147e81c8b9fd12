// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/calibration/model.hpp"

#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

std::string fine_mm(double metres) {
  return fmt::format("{:.4f} mm", 1e3 * metres);
}

std::string means(const ErrorChange& change) {
  return fmt::format("from {} to {}", fine_mm(change.mean_before), fine_mm(change.mean_after));
}

std::string missing_data(MissingData missing) {
  switch (missing) {
    case MissingData::gravity:
      return "gravity is zero in the robot file";
    case MissingData::torques:
      return "no joint torques were measured (columns tau1, tau2, …)";
    case MissingData::approach_order:
      return "the order in which the poses were driven to is not known";
    case MissingData::temperature:
      return "no temperature was measured";
    case MissingData::temperature_range:
      return "the temperature hardly changed (less than 1 K)";
    case MissingData::spectral_line:
      return "the spectrum of the residuals shows no further line";
    case MissingData::none:
      break;
  }
  return "";
}

}  // namespace

std::string description(const SelectionStep& step) {
  if (!step.term) return phrase("geometry", "the complete geometric set");
  const std::string_view id = name(*step.term);
  switch (*step.term) {
    case Term::gain:
      return phrase(id, "a gain of each turning joint's encoder");
    case Term::coupling:
      return phrase(id,
                    "how far each turning joint follows the readings of the two before it (transmissions, "
                    "parallelograms)");
    case Term::gravity_compliance:
      return step.masses_approximate
                 ? phrase(id,
                          "compliance of each turning joint under gravity, with masses guessed from the lengths of the "
                          "links")
                 : phrase(id, "compliance of each turning joint under gravity");
    case Term::torque_compliance:
      return phrase(id, "compliance of each joint by its measured torque");
    case Term::gear_harmonics:
      return phrase(id, "what comes back once and twice a turn of each joint (eccentric gears and encoders)");
    case Term::spectral_harmonics:
      return phrase(id, "what else the spectrum of the residuals shows");
    case Term::backlash:
      return phrase(id, "a shift by the side from which each joint was approached (the order of the rows)");
    case Term::thermal_expansion:
      return phrase(id, "thermal growth of all lengths");
  }
  return "";
}

std::string reason(const SelectionStep& step) {
  const std::string_view id = name(step.decision);
  const ErrorChange &inside = step.interpolation, &outside = step.extrapolation;
  const std::string held_out = "the held-out mean goes " + means(inside);
  switch (step.decision) {
    case Decision::start:
      return phrase(id, "where every robot begins");
    case Decision::requested:
      return phrase(id, "as requested");
    case Decision::accepted:
      return phrase(id, "taken: {} ({:.0f} standard errors){}", held_out, inside.t,
                    outside.mean_before > 0.0 ? "; beyond the fitted poses " + means(outside) : "");
    case Decision::no_improvement:
      return phrase(id, "refused: {}", held_out);
    case Decision::not_significant:
      return phrase(id, "refused: {}, which chance explains ({:.1f} standard errors)", held_out, inside.t);
    case Decision::worst_error_rises:
      return phrase(id, "refused: {}, but the worst held-out error rises from {} to {}", held_out,
                    fine_mm(inside.worst_before), fine_mm(inside.worst_after));
    case Decision::extrapolation_worse:
      return phrase(id, "refused: {} ({:.0f} standard errors), but beyond the fitted poses the mean rises {}", held_out,
                    inside.t, means(outside));
    case Decision::not_excited:
      return phrase(id, "not tested: these poses do not excite its terms");
    case Decision::data_missing:
      return phrase(id, "not tested: {}", missing_data(step.missing));
  }
  return "";
}

}  // namespace kinfer::words
