// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/identification/identification_evidence.hpp"

namespace kinfer {
namespace {

std::vector<SearchRow> search_rows(const std::vector<DhRowEstimate>& rows) {
  std::vector<SearchRow> result;
  for (const DhRowEstimate& row : rows) result.push_back({row});
  return result;
}

}  // namespace

FitRecord fit_record(const std::vector<LinkEvidence>& searches) {
  FitRecord record;
  for (const LinkEvidence& s : searches) {
    record.fitted.push_back({s.fitted, s.segment, s.rows});
    record.holdout.emplace_back(s.segment, s.holdout);
  }
  return record;
}

StructureSearchRecord structure_search_record(const Identification& identification) {
  StructureSearchRecord record{.method = identification.search_method};
  record.is_start = identification.starts_from_search;
  for (const LinkEvidence& s : identification.searches) {
    record.evaluations += s.evaluations;
    record.generations += s.generations;
    record.best.push_back(s.best);
    record.median.push_back(s.median);
    record.segments.push_back(
        {s.segment, s.evaluations, s.written_fitted, s.written_holdout, search_rows(s.found), search_rows(s.merged)});
  }
  return record;
}

}  // namespace kinfer
