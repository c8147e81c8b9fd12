// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/findings/pose_set_findings.hpp"

#include <algorithm>

#include "kinfer/base/expect.hpp"
#include "kinfer/words/findings/finding_words.hpp"

namespace kinfer::words {
namespace {

const FindingWords& words_of(FindingKind kind) {
  for (const std::span<const FindingWords> table : {convention_words(), row_words()})
    if (const auto at = std::ranges::find(table, kind, &FindingWords::kind); at != table.end()) return *at;
  KINFER_EXPECT(false, "{} is not a finding about pose sets", name(kind));
  return convention_words().front();
}

}  // namespace

std::string pose_set_finding_sentence(const Finding& finding) {
  std::string text = words_of(finding.kind).sentence(finding);
  for (const Finding& other : finding.equivalents)
    text += "; or, which comes to the same, " + words_of(other.kind).sentence(other);
  return text;
}

std::string pose_set_finding_suggestion(const Finding& finding) {
  return words_of(finding.kind).suggestion(finding);
}

std::string pose_set_finding_note(const Finding& finding) {
  const std::string remedy = pose_set_finding_suggestion(finding);
  const std::string text = pose_set_finding_sentence(finding);
  if (finding.applied) return text + "; corrected before the fit (in the files: " + remedy + ")";
  return text + "; " + remedy;
}

}  // namespace kinfer::words
