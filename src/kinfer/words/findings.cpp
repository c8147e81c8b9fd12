// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/findings.hpp"

#include "kinfer/words/pose_set_findings.hpp"

namespace kinfer::words {

std::string sentence(const Finding& finding) {
  return finding.sentence.empty() ? pose_set_finding_sentence(finding) : finding.sentence;
}

std::string suggestion(const Finding& finding) {
  return finding.sentence.empty() ? pose_set_finding_suggestion(finding) : finding.suggestion;
}

}  // namespace kinfer::words
