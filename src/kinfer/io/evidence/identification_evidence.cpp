// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/identification/identification_evidence.hpp"

#include <algorithm>

#include "kinfer/io/evidence/identification_json.hpp"
#include "kinfer/io/evidence/make_records.hpp"
#include "kinfer/io/evidence/plot_rounding.hpp"
#include "kinfer/words/identification/advice.hpp"
#include "kinfer/words/identification/joint_verdict.hpp"
#include "kinfer/words/identification/notes.hpp"
#include "kinfer/words/identification/unobservable.hpp"
#include "kinfer/words/identification/update.hpp"
#include "kinfer/words/identification/verdict.hpp"

namespace kinfer {
namespace {

void set_verdict(JointRecord& record, const JointVerdict& verdict) {
  record.usability = verdict.usability;
  record.connection = verdict.connection;
  for (const JointDoubt& doubt : verdict.doubts) record.doubts.push_back({doubt, words::doubt_sentence(doubt)});
}

JointRecord joint_record(const JointEstimate& joint) {
  JointRecord record{.estimate = joint, .sentences = words::unobservable_sentences(joint)};
  for (const Unobservable& u : joint.unobservable)
    record.unobservable.push_back({u, words::unobservable_text(u, joint), words::remedy_text(u)});
  record.estimate.unobservable.clear();
  record.estimate.trajectory = {};
  return record;
}

std::vector<JointRecord> joint_records(const Identification& result) {
  std::vector<JointRecord> records;
  for (const JointEstimate& joint : result.joints) records.push_back(joint_record(joint));
  for (std::size_t i = 0; i < std::min(records.size(), result.verdicts.size()); ++i)
    set_verdict(records[i], result.verdicts[i]);
  return records;
}

std::vector<ClockRecord> clock_records(const std::vector<SensorClockEstimate>& clocks) {
  std::vector<ClockRecord> records;
  for (const SensorClockEstimate& c : clocks)
    records.push_back({c.sensor, c.offset, c.offset_sd, 1e6 * c.drift, 1e6 * c.drift_sd});
  return records;
}

std::optional<ChainUpdateRecord> update_record(const std::optional<ChainUpdate>& update) {
  if (!update) return std::nullopt;
  ChainUpdateRecord record{.sentence = words::update_sentence(*update),
                           .changes = {},
                           .parts = update->parts,
                           .squared_distance = update->squared_distance,
                           .freedom = update->freedom,
                           .is_other_machine = update->is_other_machine};
  for (const ChainChange& change : update->changes) record.changes.push_back({change, words::change_sentence(change)});
  return record;
}

}  // namespace

IdentificationEvidence identification_evidence(const Identification& i, const Provenance& provenance) {
  return {.verdict = {words::identification_verdict(i), i.usability, words::identification_verdict_text(i)},
          .findings = finding_records(i.findings),
          .notes = words::note_sentences(i),
          .root = i.root,
          .joints = joint_records(i),
          .loops = i.loops,
          .links = i.links,
          .dh = i.dh,
          .chain = chain_view(i.chain),
          .next = words::advice_texts(i.advice),
          .places = i.places,
          .clocks = clock_records(i.clocks),
          .forecast = i.forecast,
          .order = i.order,
          .fit = fit_record(i.searches),
          .search = structure_search_record(i),
          .motion = rounded(i.motion),
          .update = update_record(i.update),
          .provenance = provenance_record(provenance)};
}

}  // namespace kinfer
