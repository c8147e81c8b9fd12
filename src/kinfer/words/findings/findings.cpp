// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/findings/findings.hpp"

#include "kinfer/words/findings/pose_set_findings.hpp"
#include "kinfer/words/findings/recording_findings.hpp"

namespace kinfer::words {

std::string sentence(const Finding& finding) {
  return is_recording_finding(finding.kind) ? recording_finding_sentence(finding) : pose_set_finding_sentence(finding);
}

std::string suggestion(const Finding& finding) {
  return is_recording_finding(finding.kind) ? recording_finding_suggestion(finding)
                                            : pose_set_finding_suggestion(finding);
}

}  // namespace kinfer::words
