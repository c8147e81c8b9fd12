// SPDX-License-Identifier: Apache-2.0
// Time stamps as an identification uses them: sensors that took turns in the rows of one file get rows of their own,
// and stamps that scatter about regular sampling give way to the regular times where the signals are smoother at these.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/evidence/facts/findings.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer::identify {

struct MendedTimeStamps {
  std::optional<InsRecording> recording;  ///< empty if all stamps stay as they are
  std::vector<Finding> findings;          ///< one for each logger whose stamps were replaced
};

MendedTimeStamps mend_time_stamps(const InsRecording& recording, int threads);

}  // namespace kinfer::identify
