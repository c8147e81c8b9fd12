// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/frames_json.hpp"

#include "kinfer/geometry/rotation.hpp"
#include "kinfer/io/evidence/json/shared_fields.hpp"
#include "kinfer/io/text/dump_json.hpp"
#include "kinfer/words/calibration/frames.hpp"

namespace kinfer {
namespace evidence_json {

template <class Archive>
void fields(Archive& a, Value<Archive, SweepCircle>& c) {
  a("name", c.name);
  a("joint", c.joint);
  a("rows", c.rows);
  a("swept_rad", c.swept);
  a("centre", c.centre);
  a("axis", c.axis);
  a("radius", c.radius);
  a("rms", c.rms);
  a.group("sd", [&](auto& sd) {
    sd("centre_m", c.centre_sd);
    sd("axis_rad", c.axis_sd);
    sd("radius_m", c.radius_sd);
  });
  a("off_by", c.off_by);
  a("turned_by", c.axis_angle);
}

template <class Archive>
void fields(Archive& a, Value<Archive, FrameRecord>& frame) {
  a("xyz", frame.xyz);
  a("rpy", frame.rpy);
}

template <class Archive>
void fields(Archive& a, Value<Archive, FramesEvidence>& e) {
  a.constant("format", format_name);
  a.constant("kind", "frames");
  a("base", e.base);
  a("base_from", e.base_source);
  a("tool", e.tool);
  a.group("papers_tool_length", [&](auto& length) {
    length("from", e.tool_source);
    length.when(e.tool_length_source.has_value(), "source", e.tool_length_source);
    length("value", e.tool_length);
  });
  a.group("closed_form_start", [&](auto& start) {
    start("base_differs_m", e.base_differs);
    start("base_turned_rad", e.base_turned);
    start("tool_differs_m", e.tool_differs);
  });
  a("sweeps", e.sweeps);
}

}  // namespace evidence_json

namespace {

FrameRecord frame_record(const Frame& frame) {
  const Pose pose = frame.pose();
  return {pose.position, to_rpy(pose.rotation)};
}

}  // namespace

FramesEvidence frames_evidence(const FrameEstimate& estimate) {
  FramesEvidence evidence{.base = frame_record(estimate.chain.base),
                          .base_source = words::base_source(estimate),
                          .tool = frame_record(estimate.chain.tool),
                          .tool_length = estimate.tool_length,
                          .tool_source = words::tool_length_source(estimate),
                          .tool_length_source = estimate.tool_length_source,
                          .base_differs = estimate.base_differs,
                          .base_turned = estimate.base_turned,
                          .tool_differs = estimate.tool_differs,
                          .sweeps = estimate.sweeps};
  for (SweepCircle& sweep : evidence.sweeps) sweep.name = words::sweep_name(sweep);
  return evidence;
}

std::string format_frames_evidence(const FramesEvidence& evidence) {
  return dump_json(evidence_json::JsonWriter::object_of(evidence), 1) + "\n";
}

Result<FramesEvidence> read_frames_evidence(std::string_view text) {
  return evidence_json::read_text<FramesEvidence>(text);
}

nlohmann::ordered_json frames_schema() {
  return evidence_json::JsonSchemaWriter::object_schema<FramesEvidence>();
}

}  // namespace kinfer
