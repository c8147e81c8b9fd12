// SPDX-License-Identifier: Apache-2.0
// Alarms of a tracker on simulated machines: false ones on healthy drives, and how soon a fault is named.
#pragma once

#include <string>
#include <vector>

namespace kinfer::study::track_study {

struct AlarmStudy {
  std::vector<std::string> machines, grades;
  int first_seed = 1, seeds = 1;
  double duration = 60.0;  ///< [s] of each drive
};

/// Prints, for each machine, grade and seed, the alarms on standard, quick and gentle drives and on a rocking base;
/// then the time from the beginning of a fault (a sensor turned by 0.5°, 3 mm of pin play; the log of another machine)
/// to its alarm.
void study_alarms(const AlarmStudy& study);

}  // namespace kinfer::study::track_study
