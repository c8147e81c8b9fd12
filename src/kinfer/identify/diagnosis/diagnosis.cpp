// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/diagnosis/diagnosis.hpp"

#include <numeric>

#include "kinfer/identify/diagnosis/axes.hpp"
#include "kinfer/identify/diagnosis/lags.hpp"
#include "kinfer/identify/diagnosis/rows.hpp"
#include "kinfer/identify/diagnosis/signs.hpp"
#include "kinfer/identify/diagnosis/units.hpp"
#include "kinfer/identify/screening/duplicates.hpp"

namespace kinfer::identify {
namespace {

std::vector<Finding> duplicates_of(const InsRecording& recording) {
  std::vector<std::size_t> all(recording.sensors.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return duplicate_findings(recording, all);
}

}  // namespace

Result<LogDiagnosis> diagnose_log(const InsRecording& recording, int threads) {
  MendedLog log(recording);
  log.findings = duplicates_of(recording);
  if (const auto forces = mend_forces(log); !forces) return forward_error(forces.error());
  mend_clocks(log, threads);
  mend_fields(log);
  if (const auto rates = refuse_attitudes(log.log()); !rates) return forward_error(rates.error());
  mend_rows(log, threads);
  mend_axes(log, threads);
  mend_signs(log, threads);
  mend_lags(log, threads);
  LogDiagnosis diagnosis{.mended = std::nullopt, .findings = std::move(log.findings)};
  diagnosis.mended = log.take();
  return diagnosis;
}

}  // namespace kinfer::identify
