// SPDX-License-Identifier: Apache-2.0
// Members of the structs of an identification, in the order of the file.
#pragma once

#include "kinfer/evidence/identification/identification_evidence.hpp"
#include "kinfer/io/evidence/json/shared_fields.hpp"

namespace kinfer::evidence_json {

template <class Archive>
void fields(Archive& a, Value<Archive, JointStandardDeviation>& sd) {
  a("axis_in_parent_rad", sd.axis_in_parent);
  a("point_in_parent_m", sd.point_in_parent);
  a("axis_in_child_rad", sd.axis_in_child);
  a("point_in_child_m", sd.point_in_child);
  a("slide_m", sd.along_axis);
}

template <class Archive>
void fields(Archive& a, Value<Archive, JointTypeProbabilities>& types) {
  for (std::size_t i = 0; i < types.of_type.size(); ++i)
    a(name(static_cast<EstimatedJointType>(i)).data(), types.of_type[i]);
}

template <class Archive>
void fields(Archive& a, Value<Archive, UnobservableRecord>& record) {
  auto& u = record.unobservable;
  a("kind", u.kind);
  UnobservableRemedy means = remedy(u.kind);
  a("remedy", means);
  a("what", record.what);
  a("how", record.how);
  a.when(!u.sensor.empty(), "sensor", u.sensor);
  a.when(!u.directions.empty(), "directions", u.directions);
  a.when(!u.other_joint.empty(), "other_joint", u.other_joint);
}

template <class Archive>
void fields(Archive& a, Value<Archive, JointDoubtRecord>& record) {
  a("kind", record.doubt.kind);
  a("sentence", record.sentence);
  a("values", record.doubt.values);
}

template <class Archive>
void fields(Archive& a, Value<Archive, JointConnection>& connection) {
  a("force_gain", connection.force_gain);
  a("rate_gain", connection.rate_gain);
  a("gain_spread", connection.gain_spread);
  a("residual", connection.residual);
  a("shifted_residual", connection.shifted_residual);
  a("shifted_rate", connection.shifted_rate);
}

/// A spherical joint has no axis. What is not known is null; the reason is among the sentences of not_identifiable.
template <class Archive>
void fields(Archive& a, Value<Archive, JointRecord>& record) {
  auto& joint = record.estimate;
  a("parent", joint.parent);
  a("child", joint.child);
  a("type", joint.type);
  a.when(joint.type_probabilities.has_value(), "type_probabilities", joint.type_probabilities);
  const bool parent_axis = is_axis_known(joint, joint.sd.axis_in_parent),
             parent_point = is_point_known(joint.sd.point_in_parent, joint.unobservable_in_parent),
             child_axis = is_axis_known(joint, joint.sd.axis_in_child),
             child_point = is_point_known(joint.sd.point_in_child, joint.unobservable_in_child);
  a.known(parent_axis, "axis_in_parent", joint.axis_in_parent);
  a.known(parent_point, "point_in_parent", joint.point_in_parent);
  a.known(child_axis, "axis_in_child", joint.axis_in_child);
  a.known(child_point, "point_in_child", joint.point_in_child);
  a("sd", joint.sd);
  a("not_identifiable", record.sentences);
  a("not_identifiable_in_parent", joint.unobservable_in_parent);
  a("not_identifiable_in_child", joint.unobservable_in_child);
  a.later("unobservable", record.unobservable);
  a.when(joint.azimuth_unobservable, "azimuth_undetermined", joint.azimuth_unobservable);
  a.later("usability", record.usability);
  a.later("doubts", record.doubts);
  a.later("connection", record.connection);
}

template <class Archive>
void fields(Archive& a, Value<Archive, LoopEstimate>& loop) {
  auto& joint = loop.joint;
  a("first", joint.parent);
  a("second", joint.child);
  a("segments", loop.segments);
  a("axis_in_first", joint.axis_in_parent);
  a("point_in_first", joint.point_in_parent);
  a("axis_in_second", joint.axis_in_child);
  a("point_in_second", joint.point_in_child);
  a("sd", joint.sd);
  a("open_gap_m", loop.gap);
  a("open_misalignment_rad", loop.misalignment);
  a("mirrored_gap_m", loop.mirrored_gap);
  a("log_odds", loop.log_odds);
}

/// What the logs do not tell is left out.
template <class Archive>
void size_fields(Archive& a, Value<Archive, std::optional<ChangeSize>>& size, const char* key, const char* sd_key) {
  ChangeSize s = size.value_or(ChangeSize{.value = std::numeric_limits<double>::quiet_NaN()});
  a.when(size.has_value(), key, s.value);
  a.when(size.has_value(), sd_key, s.sd);
  if constexpr (!Archive::is_writer)
    if (std::isfinite(s.value)) size = s;
}

template <class Archive>
void fields(Archive& a, Value<Archive, ChainChangeRecord>& record) {
  auto& change = record.change;
  a("kind", change.kind);
  a("name", change.name);
  a("segment", change.segment);
  a.when(!change.alternative.empty(), "alternative", change.alternative);
  size_fields(a, change.angle, "angle_rad", "angle_sd_rad");
  size_fields(a, change.distance, "distance_m", "distance_sd_m");
  a("log_odds", change.log_odds);
  a("sentence", record.sentence);
}

/// The difference of an axis is in rad, that of a point in m.
template <class Archive>
void fields(Archive& a, Value<Archive, ChainPartComparison>& part) {
  a("joint", part.joint);
  a("sensor", part.sensor);
  a("quantity", part.quantity);
  a("difference", part.difference);
  a("sd", part.sd);
  a("squared_distance", part.squared_distance);
  a("freedom", part.freedom);
}

template <class Archive>
void fields(Archive& a, Value<Archive, ChainUpdateRecord>& update) {
  a("sentence", update.sentence);
  a("changes", update.changes);
  a("parts", update.parts);
  a("squared_distance", update.squared_distance);
  a("freedom", update.freedom);
  a("is_other_machine", update.is_other_machine);
}

/// Only where the axes are nearly parallel.
template <class Archive>
void pin_fields(Archive& a, Value<Archive, std::optional<PinDistance>>& pin) {
  PinDistance p = pin.value_or(PinDistance{.distance = std::numeric_limits<double>::quiet_NaN()});
  a.when(pin.has_value(), "pin_distance_m", p.distance);
  a.when(pin.has_value(), "pin_distance_sd_m", p.sd);
  a.when(pin.has_value(), "pin_line", p.direction);
  a.when(pin.has_value(), "pin_line_sd_rad", p.direction_sd);
  if constexpr (!Archive::is_writer)
    if (std::isfinite(p.distance)) pin = p;
}

template <class Archive>
void fields(Archive& a, Value<Archive, LinkEstimate>& link) {
  a("segment", link.segment);
  a("from", link.from);
  a("to", link.to);
  a("length_m", link.length);
  a("sd_m", link.sd);
  a.later("axis_angle_rad", link.axis_angle);
  pin_fields(a, link.pin);
}

template <class Archive>
void fields(Archive& a, Value<Archive, PointEstimate>& point) {
  a("name", point.name);
  a("sensor", point.sensor);
  a("xyz", point.xyz);
  a("sd_m", point.sd);
}

template <class Archive>
void fields(Archive& a, Value<Archive, ClockRecord>& clock) {
  a("sensor", clock.sensor);
  a("offset_s", clock.offset);
  a("drift_ppm", clock.drift);
  a.group("sd", [&](auto& sd) {
    sd("offset_s", clock.offset_sd);
    sd("drift_ppm", clock.drift_sd);
  });
}

template <class Archive>
void fields(Archive& a, Value<Archive, JointForecast>& f) {
  a("joint", f.joint);
  a("line_sd_m", f.line_sd);
  a("direction_sd_rad", f.direction_sd);
  a("enough", f.is_sufficient);
  a("acceleration_factor", f.acceleration_factor);
  a("time_factor", f.time_factor);
  a.when(!f.azimuth_of.empty(), "azimuth_of", f.azimuth_of);
  a.when(!f.azimuth_of.empty(), "azimuth_sd_rad", f.azimuth_sd);
}

/// A row of a search; beta and the standard deviations are those of the final table alone.
template <class Archive>
void search_row_fields(Archive& a, Value<Archive, DhRowEstimate>& row) {
  a("segment", row.segment);
  a("theta", row.row.theta);
  a("d", row.row.d);
  a("a", row.row.a);
  a("alpha", row.row.alpha);
  a("theta_variable", row.theta_variable);
  a.later("alpha_variable", row.alpha_variable);
  a.later("d_variable", row.d_variable);
}

template <class Archive>
void fields(Archive& a, Value<Archive, DhRowEstimate>& row) {
  search_row_fields(a, row);
  a.later("beta", row.row.beta);
  a.group("sd", [&](auto& sd) {
    sd("theta", row.sd.theta);
    sd("d", row.sd.d);
    sd("a", row.sd.a);
    sd("alpha", row.sd.alpha);
    sd.later("beta", row.sd.beta);
  });
}

template <class Archive>
void fields(Archive& a, Value<Archive, SearchRow>& row) {
  search_row_fields(a, row.row);
}

template <class Archive>
void fields(Archive& a, Value<Archive, PairEvidence>& pair) {
  a("first", pair.first);
  a("second", pair.second);
  a("residual", pair.residual);
  a("off_axis_rate", pair.off_axis_rate);
  a.later("weight", pair.weight);
  a("joined", pair.joined);
}

template <class Archive>
void fields(Archive& a, Value<Archive, PhaseEvidence>& phase) {
  a("begin", phase.begin);
  a("end", phase.end);
  a("moves", phase.moves);
}

template <class Archive>
void fields(Archive& a, Value<Archive, OrderEvidence>& order) {
  a("sensors", order.sensors);
  a("pairs", order.pairs);
  a("margin", order.margin);
  a("phases", order.phases);
  a("rank", order.rank);
  a("phases_agree", order.phases_agree);
}

template <class Archive>
void fields(Archive& a, Value<Archive, LinkFit>& fit) {
  a("total", fit.total);
  a("acceleration", fit.acceleration);
  a("orientation", fit.orientation);
}

template <class Archive>
void fields(Archive& a, Value<Archive, SegmentFitRecord>& fit) {
  fields(a, fit.fitted);
  a("segment", fit.segment);
  a("rows", fit.rows);
}

template <class Archive>
void fields(Archive& a, Value<Archive, FitRecord>& fit) {
  a("jrmse", fit.fitted);
  a.map("holdout", fit.holdout);
}

template <class Archive>
void fields(Archive& a, Value<Archive, SegmentSearchRecord>& search) {
  a("segment", search.segment);
  a("evaluations", search.evaluations);
  a.when(search.written_fitted.has_value(), "written_fitted", search.written_fitted);
  a.when(search.written_holdout.has_value(), "written_holdout", search.written_holdout);
  a("found", search.found);
  a("merged", search.merged);
}

inline void check_curves(JsonReader& a, const StructureSearchRecord& search) {
  if (search.best.size() != search.median.size()) a.error("median", "expected one list for each of best");
}
inline void check_curves(auto&, const StructureSearchRecord&) {}

template <class Archive>
void fields(Archive& a, Value<Archive, StructureSearchRecord>& search) {
  a("engine", search.method);
  a("evaluations", search.evaluations);
  a("generations", search.generations);
  a("best", search.best);
  a("median", search.median);
  a.later("segments", search.segments);
  a.later("is_start_of_fit", search.is_start);
  check_curves(a, search);
}

}  // namespace kinfer::evidence_json
