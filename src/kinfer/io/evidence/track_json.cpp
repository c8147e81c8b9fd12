// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/track_json.hpp"

#include <cmath>
#include <limits>

#include "kinfer/io/evidence/json/shared_fields.hpp"
#include "kinfer/io/evidence/make_records.hpp"
#include "kinfer/io/text/dump_json.hpp"
#include "kinfer/words/tracking/track_run.hpp"

namespace kinfer {
namespace evidence_json {

template <class Archive>
void fields(Archive& a, Value<Archive, TrackCurve>& curve) {
  a("name", curve.name);
  a("rotates", curve.rotates);
  a.plotted_list("low", curve.low);
  a.plotted_list("high", curve.high);
  a.plotted_list("sd", curve.sd);
}

template <class Archive>
void fields(Archive& a, Value<Archive, TrackSensorCurve>& curve) {
  a("name", curve.name);
  a.plotted_list("innovation", curve.innovation);
}

/// Only of a sensor that was turned before the first row.
template <class Archive>
void turn_fields(Archive& a, Value<Archive, std::optional<SensorTurn>>& turn) {
  SensorTurn size = turn.value_or(SensorTurn{.angle = std::numeric_limits<double>::quiet_NaN()});
  a.when(turn.has_value(), "turn_rad", size.angle);
  a.when(turn.has_value(), "turn_sd_rad", size.sd);
  a.when(turn.has_value(), "turn_hidden_sd_rad", size.hidden_sd);
  if constexpr (!Archive::is_writer)
    if (std::isfinite(size.angle)) turn = size;
}

template <class Archive>
void fields(Archive& a, Value<Archive, TrackEvent>& event) {
  a("kind", event.alarm.kind);
  a("sensor", event.alarm.sensor);
  a("joint", event.alarm.joint);
  a("since", event.alarm.since);
  a("until", event.until);
  a("strength", event.alarm.strength);
  turn_fields(a, event.alarm.turn);
  a("sentence", event.sentence);
}

template <class Archive>
void fields(Archive& a, Value<Archive, TrackJointShare>& joint) {
  a("name", joint.name);
  a("composed", joint.composed);
  a("relative_to_start", joint.relative_to_start);
  a("unknown", joint.unknown);
}

/// Every curve has one value for each time.
inline void check_curves(JsonReader& a, const TrackRun& run) {
  bool agree = run.tool.size() == run.time.size() && run.tool_sd.size() == run.time.size();
  for (const TrackCurve& curve : run.positions)
    agree = agree && curve.low.size() == run.time.size() && curve.high.size() == run.time.size() &&
            curve.sd.size() == run.time.size();
  for (const TrackSensorCurve& curve : run.sensors) agree = agree && curve.innovation.size() == run.time.size();
  if (!agree) a.error("time", "expected as many times as values");
}
inline void check_curves(auto&, const TrackRun&) {}

template <class Archive>
void fields(Archive& a, Value<Archive, TrackRun>& run) {
  a.constant("format", format_name);
  a.constant("kind", "track");
  verdict_fields(a, run.verdict);
  a("begin", run.begin);
  a("end", run.end);
  a("rows", run.rows);
  a("events", run.events);
  a("joints", run.joints);
  a("remarks", run.remarks);
  a.plotted_list("time", run.time);
  a("positions", run.positions);
  a("sensors", run.sensors);
  a("tool", run.tool);
  a.plotted_list("tool_sd", run.tool_sd);
  check_curves(a, run);
  a("provenance", run.provenance);
}

}  // namespace evidence_json

TrackRun track_evidence(const TrackRun& run, const Provenance& provenance) {
  TrackRun evidence = words::with_sentences(run);
  evidence.provenance = provenance_record(provenance);
  return evidence;
}

std::string format_track_run(const TrackRun& run) {
  return dump_json(evidence_json::JsonWriter::object_of(run), 1) + "\n";
}

Result<TrackRun> read_track_run(std::string_view text) {
  return evidence_json::read_text<TrackRun>(text);
}

nlohmann::ordered_json track_schema() {
  return evidence_json::JsonSchemaWriter::object_schema<TrackRun>();
}

}  // namespace kinfer
