// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/diagnosis/diagnose.hpp"

#include <algorithm>

#include "kinfer/calibrate/diagnosis/conventions.hpp"
#include "kinfer/calibrate/diagnosis/fit_residuals.hpp"
#include "kinfer/calibrate/diagnosis/joint_lag.hpp"
#include "kinfer/calibrate/diagnosis/joint_positions.hpp"
#include "kinfer/calibrate/diagnosis/row_pairing.hpp"
#include "kinfer/calibrate/start/fixtures.hpp"

namespace kinfer::calibrate {
namespace {

/// An uncorrected fault of the whole set: no fit is meaningful.
bool prevents_fit(const Finding& finding) {
  return finding.severity == Severity::fault && !finding.applied && finding.rows.empty();
}

}  // namespace

Diagnosis diagnose(const CalibrationTask& task, const AlternativeOrientations& alternatives) {
  DiagnosisState state{task, {}};
  const auto placed = with_fixtures(task.nominal, task.data);
  if (task.data.rows() == 0 || !placed) return {{}, task};
  state.task.nominal = placed->chain;
  state.task.data = placed->data;
  if (check_pairing(state) == PairingEvaluated::no) {
    check_conventions(state);
    check_pairing(state);
  }
  const bool explained = std::none_of(state.findings.begin(), state.findings.end(), prevents_fit);
  check_joint_positions(state);
  check_duplicate_rows(state);
  check_target_rigidity(state);
  if (explained) {
    check_orientations(state, alternatives);
    check_commanded_positions(state);
    check_joint_lag(state);
    check_residuals(state);
  }
  return {std::move(state.findings), std::move(state.task)};
}

Diagnosis diagnose_joint_positions(const CalibrationTask& task) {
  DiagnosisState state{task, {}};
  const auto placed = with_fixtures(task.nominal, task.data);
  if (task.data.rows() == 0 || !placed) return {{}, task};
  state.task.nominal = placed->chain;
  state.task.data = placed->data;
  check_commanded_positions(state);
  check_joint_lag(state);
  return {std::move(state.findings), std::move(state.task)};
}

}  // namespace kinfer::calibrate
