// SPDX-License-Identifier: Apache-2.0
// The words of findings, one row per kind, in tables by subject.
#pragma once

#include <span>
#include <string>

#include "kinfer/base/angle.hpp"
#include "kinfer/evidence/facts/findings.hpp"

namespace kinfer::words {

struct FindingWords {
  FindingKind kind;
  std::string (*sentence)(const Finding&);
  std::string (*suggestion)(const Finding&);
};

/// Units, signs, offsets and columns that disagree with the robot file.
std::span<const FindingWords> convention_words();

/// Rows, joints and targets.
std::span<const FindingWords> row_words();

inline double value_in_mm(const Finding& finding, std::string_view value) {
  return 1e3 * finding.values.number(value);
}
inline double value_in_deg(const Finding& finding, std::string_view value) {
  return finding.values.number(value) / degree;
}

}  // namespace kinfer::words
