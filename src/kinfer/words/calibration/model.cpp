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

std::string tail(const ErrorChange& change) {
  return fmt::format("95 and 99 % of the errors are below {} and {} instead of {} and {}", fine_mm(change.p95.after),
                     fine_mm(change.p99.after), fine_mm(change.p95.before), fine_mm(change.p99.before));
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
      return "the residuals have no further significant harmonic";
    case MissingData::points:
      return "it needs 20 or more measured points of one tool";
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
      return phrase(id, "a gain of each revolute joint's encoder");
    case Term::coupling:
      return phrase(id,
                    "how far each revolute joint follows the positions of the two before it (transmissions, "
                    "parallelograms)");
    case Term::gravity_compliance:
      return step.masses_approximate
                 ? phrase(
                       id,
                       "compliance of each revolute joint under gravity, with masses estimated from the lengths of the "
                       "links")
                 : phrase(id, "compliance of each revolute joint under gravity");
    case Term::torque_compliance:
      return phrase(id, "compliance of each joint by its measured torque");
    case Term::gear_harmonics:
      return phrase(id, "errors of period one and one half revolution of each joint (eccentric gears and encoders)");
    case Term::spectral_harmonics:
      return phrase(id, "further harmonics of joint positions, found in the residuals");
    case Term::backlash:
      return phrase(id, "backlash: an offset with the sign of the direction of approach (from the order of the rows)");
    case Term::thermal_expansion:
      return phrase(id, "thermal expansion of all lengths");
    case Term::displacement_field:
      return phrase(id, "a displacement of the tool that is a smooth function of all joint positions, of any form");
  }
  return "";
}

std::string reason(const SelectionStep& step) {
  const std::string_view id = name(step.decision);
  const ErrorChange &inside = step.interpolation, &outside = step.extrapolation;
  const std::string held_out = "the held-out mean goes " + means(inside);
  switch (step.decision) {
    case Decision::start:
      return phrase(id, "the start of every selection");
    case Decision::requested:
      return phrase(id, "as requested");
    case Decision::accepted:
      return phrase(id, "taken: {} (log evidence {:+.1f}); it moves the tool by {}{}", held_out, step.log_evidence_gain,
                    fine_mm(step.contribution),
                    outside.mean_before > 0.0 ? "; beyond the fitted poses " + means(outside) : "");
    case Decision::no_evidence:
      return phrase(id, "refused: the data do not support it (log evidence {:+.1f})", step.log_evidence_gain);
    case Decision::no_improvement:
      return phrase(id, "refused: {}", held_out);
    case Decision::tail_rises:
      return phrase(id, "refused: {}, but {}", held_out, tail(inside));
    case Decision::extrapolation_worse:
      return phrase(id, "refused: {} ({:.0f} standard errors), but beyond the fitted poses the mean {} {}{}", held_out,
                    inside.t, outside.mean_after > outside.mean_before ? "rises" : "goes", means(outside),
                    outside.p95.rise_probability + outside.p99.rise_probability > 0.0 ? ", and " + tail(outside) : "");
    case Decision::not_excited:
      return phrase(id, "not tested: these poses do not excite its parameters");
    case Decision::data_missing:
      return phrase(id, "not tested: {}", missing_data(step.missing));
    case Decision::superseded:
      return phrase(id, "not tested: series of harmonics hold the errors of the joints");
  }
  return "";
}

}  // namespace kinfer::words
