// SPDX-License-Identifier: Apache-2.0
// Enumerators in evidence.json: each is stored by its name.
#pragma once

#include <string>
#include <string_view>

#include "kinfer/evidence/calibration/calibration.hpp"
#include "kinfer/evidence/deployment/frame_estimate.hpp"
#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/evidence/tracking/track_state.hpp"

namespace kinfer::evidence_json {

/// The last enumerator, for reading: the values run from 0 to it.
template <class Enum>
inline constexpr Enum last{};

template <>
inline constexpr auto last<Severity> = Severity::fault;
template <>
inline constexpr auto last<Usability> = Usability::do_not_use;
template <>
inline constexpr auto last<JointUsability> = JointUsability::unknown;
template <>
inline constexpr auto last<JointDoubtKind> = JointDoubtKind::inaccurate;
template <>
inline constexpr auto last<Stop> = Stop::cancelled;
template <>
inline constexpr auto last<Quantity> = Quantity::acceleration;
template <>
inline constexpr auto last<MeasurementKind> = MeasurementKind{measurement_kinds - 1};
template <>
inline constexpr auto last<Undetermined> = Undetermined::confounded;
template <>
inline constexpr auto last<SearchMethod> = SearchMethod::bpnn_pso;
template <>
inline constexpr auto last<InitialSwarm> = InitialSwarm::network;
template <>
inline constexpr auto last<Decision> = Decision::superseded;
template <>
inline constexpr auto last<MissingData> = MissingData::points;
template <>
inline constexpr auto last<AxisRelation> = AxisRelation::skew;
template <>
inline constexpr auto last<UnobservedLength> = UnobservedLength::all_lengths;
template <>
inline constexpr auto last<CalibrationReason> = CalibrationReason::unchanged;
template <>
inline constexpr auto last<CalibrationNoteKind> = CalibrationNoteKind::no_offset_moved;
template <>
inline constexpr auto last<CalibrationAdviceKind> = CalibrationAdviceKind::keep_verification_poses;
template <>
inline constexpr auto last<EstimatedJointType> = EstimatedJointType::rigid;
template <>
inline constexpr auto last<UnobservableKind> = UnobservableKind::offset_split;
template <>
inline constexpr auto last<UnobservableRemedy> = UnobservableRemedy::move_joint;
template <>
inline constexpr auto last<LinkSearchMethod> = LinkSearchMethod::enumeration;
template <>
inline constexpr auto last<ChainChangeKind> = ChainChangeKind::joint_moved;
template <>
inline constexpr auto last<ChainPartQuantity> = ChainPartQuantity::point;
template <>
inline constexpr auto last<TraceQuantity> = TraceQuantity::angular_velocity;
template <>
inline constexpr auto last<TraceFrame> = TraceFrame::sensor;
template <>
inline constexpr auto last<ToolLengthSource> = ToolLengthSource::radius_without_fit;

template <>
inline constexpr auto last<TrackAlarmKind> = TrackAlarmKind::sensor_exchanged;

template <class Enum>
std::string text_of(Enum value) {
  return std::string(name(value));
}
/// A quantity is stored as its unit.
template <>
inline std::string text_of(Quantity value) {
  return std::string(unit(value));
}
template <>
inline std::string text_of(JointType value) {
  return std::string(traits(value).name);
}

/// The names of all enumerators.
template <class Enum>
std::vector<std::string> names_of() {
  std::vector<std::string> names;
  for (int i = 0; i <= static_cast<int>(last<Enum>); ++i) names.push_back(text_of(static_cast<Enum>(i)));
  return names;
}
template <>
inline std::vector<std::string> names_of<FindingKind>() {
  return finding_kind_names();
}
template <>
inline std::vector<std::string> names_of<JointType>() {
  std::vector<std::string> names;
  for (const JointTypeTraits& type : joint_types) names.emplace_back(type.name);
  return names;
}

/// False if no enumerator has this name.
template <class Enum>
bool from_text(std::string_view text, Enum& value) {
  for (int i = 0; i <= static_cast<int>(last<Enum>); ++i)
    if (text_of(static_cast<Enum>(i)) == text) {
      value = static_cast<Enum>(i);
      return true;
    }
  return false;
}
template <>
inline bool from_text(std::string_view text, FindingKind& value) {
  const auto kind = finding_kind(text);
  if (kind) value = *kind;
  return kind.has_value();
}
template <>
inline bool from_text(std::string_view text, JointType& value) {
  const auto type = joint_type_named(text);
  if (type) value = *type;
  return type.has_value();
}

}  // namespace kinfer::evidence_json
