// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/calibration/calibration_facts.hpp"

#include <array>

namespace kinfer {
namespace {

// In the order of the enumerators.
constexpr std::array<std::string_view, 15> reason_names{
    "improves_nominal", "no_improvement", "not_validated",     "unmodelled_effects", "generalises",
    "overfitted",       "unproven",       "beyond_tolerances", "far_from_nominal",   "beyond_noise",
    "contradictory",    "collapsed",      "fault_remains",     "unexplained",        "unchanged"};
constexpr std::array<std::string_view, 8> note_names{"many_gross_errors",  "tolerances_scaled", "frames_from_data",
                                                     "urdf_geometry_only", "population_used",   "foreign_to_population",
                                                     "joint_offset_moved", "no_offset_moved"};
constexpr std::array<std::string_view, 8> advice_names{"use_corrections",    "correct_data",
                                                       "check_model",        "check_outliers",
                                                       "extend_joint_range", "measure_uncertain_region",
                                                       "measure_more_poses", "keep_verification_poses"};

constexpr std::array<std::string_view, 2> unobserved_names{"size", "all_lengths"};

}  // namespace

std::string_view name(UnobservedLength kind) {
  return unobserved_names[static_cast<std::size_t>(kind)];
}

std::string_view name(CalibrationReason reason) {
  return reason_names[static_cast<std::size_t>(reason)];
}

std::string_view name(CalibrationNoteKind kind) {
  return note_names[static_cast<std::size_t>(kind)];
}

std::string_view name(CalibrationAdviceKind kind) {
  return advice_names[static_cast<std::size_t>(kind)];
}

}  // namespace kinfer
