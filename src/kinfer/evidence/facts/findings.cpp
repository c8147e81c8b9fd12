// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/facts/findings.hpp"

#include <algorithm>
#include <array>

namespace kinfer {
namespace {

struct NamedKind {
  FindingKind kind;
  std::string_view name;
};

constexpr std::array named_kinds{
    NamedKind{FindingKind::rows_shifted, "rows_shifted"},
    NamedKind{FindingKind::rows_swapped, "rows_swapped"},
    NamedKind{FindingKind::base_moved, "base_moved"},
    NamedKind{FindingKind::base_drifts, "base_drifts"},
    NamedKind{FindingKind::degrees_for_radians, "degrees_for_radians"},
    NamedKind{FindingKind::radians_for_degrees, "radians_for_degrees"},
    NamedKind{FindingKind::length_unit, "length_unit"},
    NamedKind{FindingKind::wrong_sign, "wrong_sign"},
    NamedKind{FindingKind::joint_offset, "joint_offset"},
    NamedKind{FindingKind::columns_swapped, "columns_swapped"},
    NamedKind{FindingKind::joint_coupled, "joint_coupled"},
    NamedKind{FindingKind::mirrored, "mirrored"},
    NamedKind{FindingKind::robot_length_unit, "robot_length_unit"},
    NamedKind{FindingKind::orientation_convention, "orientation_convention"},
    NamedKind{FindingKind::not_settled, "not_settled"},
    NamedKind{FindingKind::joint_lag, "joint_lag"},
    NamedKind{FindingKind::gross_outliers, "gross_outliers"},
    NamedKind{FindingKind::joint_hardly_moves, "joint_hardly_moves"},
    NamedKind{FindingKind::outside_limits, "outside_limits"},
    NamedKind{FindingKind::outside_region, "outside_region"},
    NamedKind{FindingKind::duplicate_rows, "duplicate_rows"},
    NamedKind{FindingKind::measurement_repeated, "measurement_repeated"},
    NamedKind{FindingKind::not_rigid, "not_rigid"},
    NamedKind{FindingKind::given_link, "given_link"},
    NamedKind{FindingKind::loop, "loop"},
    NamedKind{FindingKind::several_machines, "several_machines"},
    NamedKind{FindingKind::linkage, "linkage"},
    NamedKind{FindingKind::no_joint, "no_joint"},
    NamedKind{FindingKind::fragmented_sensor, "fragmented_sensor"},
    NamedKind{FindingKind::not_connected, "not_connected"},
    NamedKind{FindingKind::other_machine, "other_machine"},
    NamedKind{FindingKind::mixed_recording, "mixed_recording"},
    NamedKind{FindingKind::duplicate_sensor, "duplicate_sensor"},
    NamedKind{FindingKind::idle, "idle"},
    NamedKind{FindingKind::remounted, "remounted"},
    NamedKind{FindingKind::clock, "clock"},
    NamedKind{FindingKind::timestamp_jitter, "timestamp_jitter"},
    NamedKind{FindingKind::clock_unit, "clock_unit"},
    NamedKind{FindingKind::clock_counts, "clock_counts"},
    NamedKind{FindingKind::force_unit, "force_unit"},
    NamedKind{FindingKind::force_scale, "force_scale"},
    NamedKind{FindingKind::rate_unit, "rate_unit"},
    NamedKind{FindingKind::field_unit, "field_unit"},
    NamedKind{FindingKind::repeated_rows, "repeated_rows"},
    NamedKind{FindingKind::interpolated_rows, "interpolated_rows"},
    NamedKind{FindingKind::rates_unrelated, "rates_unrelated"},
    NamedKind{FindingKind::rate_sign, "rate_sign"},
    NamedKind{FindingKind::left_handed, "left_handed"},
    NamedKind{FindingKind::instrument_axes, "instrument_axes"},
    NamedKind{FindingKind::force_sign, "force_sign"},
    NamedKind{FindingKind::opposite_verticals, "opposite_verticals"},
    NamedKind{FindingKind::instruments_out_of_step, "instruments_out_of_step"},
    NamedKind{FindingKind::instrument_scale, "instrument_scale"},
    NamedKind{FindingKind::clock_rate, "clock_rate"},
};

}  // namespace

std::string_view name(FindingKind kind) {
  return std::ranges::find(named_kinds, kind, &NamedKind::kind)->name;
}

std::optional<FindingKind> finding_kind(std::string_view name) {
  const auto at = std::ranges::find(named_kinds, name, &NamedKind::name);
  return at == named_kinds.end() ? std::nullopt : std::optional(at->kind);
}

std::vector<std::string> finding_kind_names() {
  std::vector<std::string> names;
  for (const NamedKind& kind : named_kinds) names.emplace_back(kind.name);
  return names;
}

bool invalidates_result(const Finding& finding) {
  return finding.severity == Severity::fault && !finding.applied;
}

bool questions_result(const Finding& finding) {
  const bool is_assumption = finding.kind == FindingKind::force_sign || finding.kind == FindingKind::clock_rate ||
                             finding.kind == FindingKind::instrument_scale;
  // A part that is left out although it moves with the others may belong to the machine.
  const bool is_doubtful_cut = finding.kind == FindingKind::several_machines && finding.values.has("connection_gain");
  return (is_assumption && !finding.applied) || is_doubtful_cut;
}

}  // namespace kinfer
