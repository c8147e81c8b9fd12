// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/conclusion/notes.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/calibrate/conclusion/thresholds.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer::calibrate {
namespace {

using Notes = std::vector<CalibrationNote>;

/// Base and tool were not free parameters, but the frames of the file were not used.
void note_frames(const Estimate& estimate, const Chain& nominal, Notes& notes) {
  for (const Parameter* parameter : estimate.parameters.free())
    if (is_own_frame_parameter(parameter->at, SetupFrame::base)) return;
  const double distance = (estimate.chain.base.xyz - nominal.base.xyz).norm();
  if (distance > 0.0) notes.push_back({CalibrationNoteKind::frames_from_data, {{"distance_m", distance}}});
}

/// Which joint offsets have changed significantly since the earlier calibration (Bonferroni's correction).
void note_offsets(const Estimate& estimate, Notes& notes) {
  const std::vector<const Parameter*> free = estimate.parameters.free();
  const auto is_offset = [](const Parameter* p) { return is_joint_parameter(p->at); };
  const auto offsets = static_cast<double>(std::count_if(free.begin(), free.end(), is_offset));
  const double limit = normal_quantile(1.0 - 0.5 * thresholds::moved_offset_risk / std::max(1.0, offsets));
  const std::size_t notes_before = notes.size();
  for (std::size_t i = 0; i < free.size(); ++i) {
    const ParameterEstimate& value = estimate.values[i];
    const double change = value.value - value.nominal;
    if (!is_offset(free[i]) || std::abs(change) <= limit * value.sd) continue;
    notes.push_back({CalibrationNoteKind::joint_offset_moved,
                     {{"parameter", value.name},
                      {value.quantity == Quantity::length ? "change_m" : "change_rad", change},
                      {"sigmas", std::abs(change) / value.sd}}});
  }
  if (notes.size() == notes_before) notes.push_back({CalibrationNoteKind::no_offset_moved});
}

}  // namespace

Notes make_notes(const Estimate& estimate, const Chain& nominal, const ExcludedRows& excluded,
                 const ToleranceScale& scale, const ParameterChoice& parameters) {
  Notes notes;
  if (excluded.too_many)
    notes.push_back({CalibrationNoteKind::many_gross_errors, {{"rows", static_cast<int>(excluded.suspect_count)}}});
  if (scale.factor > 1.0) notes.push_back({CalibrationNoteKind::tolerances_scaled, {{"factor", scale.factor}}});
  note_frames(estimate, nominal, notes);
  if (has_non_geometric_terms(estimate.chain)) notes.push_back({CalibrationNoteKind::urdf_geometry_only});
  if (std::holds_alternative<JointOffsetParameters>(parameters)) note_offsets(estimate, notes);
  return notes;
}

}  // namespace kinfer::calibrate
