// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/findings.hpp"

#include "kinfer/words/recording_findings.hpp"

namespace kinfer::words {

std::string sentence(const Finding& finding) {
  if (!finding.sentence.empty()) return finding.sentence;
  return recording_finding_sentence(finding);
}

std::string suggestion(const Finding& finding) {
  if (!finding.sentence.empty()) return finding.suggestion;
  return recording_finding_suggestion(finding);
}

}  // namespace kinfer::words
