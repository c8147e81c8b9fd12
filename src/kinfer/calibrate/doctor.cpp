#include "kinfer/calibrate/doctor.hpp"

#include <algorithm>

#include "kinfer/calibrate/doctor_conventions.hpp"
#include "kinfer/calibrate/doctor_pairing.hpp"
#include "kinfer/calibrate/doctor_readings.hpp"
#include "kinfer/calibrate/doctor_residuals.hpp"
#include "kinfer/calibrate/surroundings.hpp"

namespace kinfer {
namespace {

/// No fit tells anything while it stands.
bool stands_in_the_way(const Finding& finding) {
  return finding.severity == Severity::fault && !finding.applied && finding.rows.empty();
}

}  // namespace

Diagnosis examine(const CalibrateTask& task, const OtherReadings& readings) {
  DoctorCase patient{task, {}};
  const auto placed = with_surroundings(task.nominal, task.data);
  if (task.data.rows() == 0 || !placed) return {{}, task};
  patient.task.nominal = placed->chain;
  patient.task.data = placed->data;
  if (check_pairing(patient) == PairingJudged::no) {
    check_conventions(patient);
    check_pairing(patient);
  }
  const bool explained = std::none_of(patient.findings.begin(), patient.findings.end(), stands_in_the_way);
  check_readings(patient);
  check_copied_rows(patient);
  check_rigidity(patient);
  if (explained) {
    check_orientations(patient, readings);
    check_commanded(patient);
    check_residuals(patient);
  }
  return {std::move(patient.findings), std::move(patient.task)};
}

std::string in_words(const Finding& finding) {
  if (finding.applied)
    return finding.sentence + "; put right before the fit" +
           (finding.suggestion.empty() ? "" : " (in the files: " + finding.suggestion + ")");
  return finding.sentence + (finding.suggestion.empty() ? "" : "; " + finding.suggestion);
}

}  // namespace kinfer
