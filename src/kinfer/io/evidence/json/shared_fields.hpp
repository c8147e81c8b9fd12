// SPDX-License-Identifier: Apache-2.0
// Members of the structs that several kinds of evidence share, in the order of the file.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/facts/advice.hpp"
#include "kinfer/evidence/facts/records.hpp"
#include "kinfer/io/evidence/json/json_reader.hpp"
#include "kinfer/io/evidence/json/json_schema_writer.hpp"
#include "kinfer/io/evidence/json/json_writer.hpp"
#include "kinfer/kinematics/chain_view.hpp"

namespace kinfer::evidence_json {

constexpr const char* format_name = "kinfer-evidence/1";

/// The error of a file that was read, or nothing.
Result<Json> parse_evidence(std::string_view text);

/// Reads one kind of evidence from the text of evidence.json.
template <class Evidence>
Result<Evidence> read_text(std::string_view text) {
  KINFER_TRY(json, parse_evidence(text));
  Evidence evidence;
  ReadErrors errors;
  const JsonPath root;
  JsonReader(json, root, errors).read(json, root, evidence);
  if (errors.first()) return error("evidence.json: {}", *errors.first());
  return evidence;
}

template <class Archive>
void fields(Archive& a, Value<Archive, FindingRecord>& record) {
  auto& f = record.finding;
  a("kind", f.kind);
  a("severity", f.severity);
  a.later("rows", f.rows);
  a.later("lines", f.lines);
  a("sentence", record.sentence);
  a("suggestion", record.suggestion);
  a("applied", f.applied);
  a.later("values", f.values);
}

template <class Archive>
void fields(Archive& a, Value<Archive, Advice>& advice) {
  a("what", advice.what);
  a("why", advice.why);
}

template <class Archive>
void fields(Archive& a, Value<Archive, InputFile>& input) {
  a("name", input.name);
  a("sha256", input.sha256);
  a.when(!input.samples.empty(), "samples", input.samples);
}

template <class Archive>
void fields(Archive& a, Value<Archive, ProvenanceRecord>& p) {
  a("version", p.version);
  a("seed", p.seed);
  a.map("options", p.options);
  a("inputs", p.inputs);
  a.when(!p.earlier_inputs.empty(), "earlier_inputs", p.earlier_inputs);
}

template <class Archive>
void fields(Archive& a, Value<Archive, VerdictText>& text) {
  a("recommendation", text.recommendation);
  a("statement", text.statement);
  a("remarks", text.remarks);
}

/// "use" is false where the result must not be used. Files of earlier versions have no "usability".
template <class Archive>
void verdict_fields(Archive& a, Value<Archive, VerdictRecord>& verdict) {
  a("verdict", verdict.sentence);
  bool use = verdict.usability != Usability::do_not_use;
  a.later("use", use);
  if constexpr (!Archive::is_writer) verdict.usability = use ? Usability::use_with_care : Usability::do_not_use;
  a.later("usability", verdict.usability);
  a.when(verdict.parts.has_value(), "verdict_parts", verdict.parts);
}

template <class Archive>
void fields(Archive& a, Value<Archive, ViewPose>& pose) {
  a("xyz", pose.xyz);
  a("quat", pose.quat);
}

template <class Archive>
void fields(Archive& a, Value<Archive, JointView>& joint) {
  a("name", joint.name);
  a("parent", joint.parent);
  a("type", joint.type);
  a("reading", joint.q_index);
  a("before", joint.before);
  a("axis", joint.axis);
  a("after", joint.after);
  a("gain", joint.gain);
  a("couplings", joint.couplings);
  a.when(joint.limits.has_value(), "limits", joint.limits);
}

template <class Archive>
void fields(Archive& a, Value<Archive, TargetView>& target) {
  a("name", target.name);
  a("xyz", target.xyz);
}

/// The parent of a joint comes before it.
inline void check_joints(JsonReader& a, const ChainView& chain) {
  const int count = static_cast<int>(chain.joints.size());
  for (int i = 0; i < count; ++i)
    if (const int parent = chain.joints[static_cast<std::size_t>(i)].parent; parent < -1 || parent >= i)
      a.error("joints", "the parent of a joint must come before it");
  if (chain.tip < -1 || chain.tip >= count) a.error("tip", "no such joint");
}
inline void check_joints(auto&, const ChainView&) {}

template <class Archive>
void fields(Archive& a, Value<Archive, ChainView>& chain) {
  a("name", chain.name);
  a("base", chain.base);
  a("joints", chain.joints);
  a("tip", chain.tip);
  a("tool", chain.tool);
  a.later("targets", chain.targets);
  a.later("readings", chain.joint_variables);
  check_joints(a, chain);
}

}  // namespace kinfer::evidence_json
