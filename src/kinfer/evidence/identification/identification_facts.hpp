// SPDX-License-Identifier: Apache-2.0
// Notes on an identification and recommendations after it, as values; `words` makes the sentences.
#pragma once

#include <string_view>

#include "kinfer/evidence/facts/fact.hpp"

namespace kinfer {

enum class IdentificationNoteKind {
  several_signals,     ///< child, signals: the found chain of a link contains the joint's signals more than once
  prismatic_joint,     ///< parent, child
  universal_joint,     ///< parent, child
  spherical_joint,     ///< parent, child
  no_relative_motion,  ///< parent, child: rigid, or a joint that was not moved
  unsafe_order,        ///< margin, safe_margin
  phases_disagree,     ///< the phases in which the segments move imply another tree
  refinement_failed,   ///< reason: an error's sentence
  unexplained_motion,  ///< sensor, force_ratio, rate_ratio, force_noise [m/s²]
  limited_passband,    ///< cutoff [Hz]
  assumed_force_sign,  ///< no values: without magnetometer nothing tells whether accelerometers read +g upwards
  relaxed_joint,       ///< parent, child, axis_deviation [rad]
};
std::string_view name(IdentificationNoteKind kind);  ///< "several_signals", ...

struct IdentificationNote {
  IdentificationNoteKind kind{};
  FactValues values{};
};

enum class IdentificationAdviceKind {
  move_in_sequence,  ///< margin, safe_margin
  use_chain,         ///< no values
  move_joint,        ///< parent, child
  move_further,      ///< joint, acceleration_factor, time_factor, line_sd [m], direction_sd [rad]
  check_mounts,      ///< the same values, without the factors; joint alone where its axis is unknown
  record_on_slope,   ///< azimuths, uncertain_azimuths, azimuth_sds [rad], azimuth_unobservable (0 or 1), points_in
  measure_tool,      ///< sensor
};
std::string_view name(IdentificationAdviceKind kind);  ///< "move_in_sequence", ...

struct IdentificationAdvice {
  IdentificationAdviceKind kind{};
  FactValues values{};
};

}  // namespace kinfer
