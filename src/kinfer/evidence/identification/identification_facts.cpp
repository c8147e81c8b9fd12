// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/identification/identification_facts.hpp"

namespace kinfer {

std::string_view name(IdentificationNoteKind kind) {
  switch (kind) {
    case IdentificationNoteKind::several_signals:
      return "several_signals";
    case IdentificationNoteKind::prismatic_joint:
      return "prismatic_joint";
    case IdentificationNoteKind::universal_joint:
      return "universal_joint";
    case IdentificationNoteKind::spherical_joint:
      return "spherical_joint";
    case IdentificationNoteKind::no_relative_motion:
      return "no_relative_motion";
    case IdentificationNoteKind::unsafe_order:
      return "unsafe_order";
    case IdentificationNoteKind::phases_disagree:
      return "phases_disagree";
    case IdentificationNoteKind::refinement_failed:
      return "refinement_failed";
    case IdentificationNoteKind::unexplained_motion:
      return "unexplained_motion";
    case IdentificationNoteKind::limited_passband:
      return "limited_passband";
    case IdentificationNoteKind::assumed_force_sign:
      return "assumed_force_sign";
    case IdentificationNoteKind::relaxed_joint:
      break;
  }
  return "relaxed_joint";
}

std::string_view name(IdentificationAdviceKind kind) {
  switch (kind) {
    case IdentificationAdviceKind::move_in_sequence:
      return "move_in_sequence";
    case IdentificationAdviceKind::use_chain:
      return "use_chain";
    case IdentificationAdviceKind::move_joint:
      return "move_joint";
    case IdentificationAdviceKind::move_further:
      return "move_further";
    case IdentificationAdviceKind::check_mounts:
      return "check_mounts";
    case IdentificationAdviceKind::record_on_slope:
      return "record_on_slope";
    case IdentificationAdviceKind::measure_tool:
      break;
  }
  return "measure_tool";
}

}  // namespace kinfer
