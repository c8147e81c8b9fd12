// SPDX-License-Identifier: Apache-2.0
// A recording that is corrected step by step; copied by the first correction only.
#pragma once

#include <optional>

#include "kinfer/estimate/continuous/model/problem.hpp"
#include "kinfer/evidence/facts/findings.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer::identify {

class MendedLog {
 public:
  explicit MendedLog(const InsRecording& original) : original_(&original) {}  ///< must outlive this

  const InsRecording& log() const { return copy_ ? *copy_ : *original_; }
  InsRecording& edit() { return copy_ ? *copy_ : copy_.emplace(*original_); }
  std::optional<InsRecording> take() { return std::move(copy_); }

  std::vector<Finding> findings;
  InsCommonScales scales;  ///< by which all instruments of a kind were divided

 private:
  const InsRecording* original_;
  std::optional<InsRecording> copy_;
};

/// Adds the sensor to the finding about this unit, or makes it; a wrong unit is certain, and corrected.
void add_unit_finding(MendedLog& log, FindingKind kind, Severity severity, double unit, const std::string& sensor);

/// Every sample v of the triad becomes factor · axes · v.
void transform(TriadColumns& triad, double factor, const Mat3& axes);

}  // namespace kinfer::identify
