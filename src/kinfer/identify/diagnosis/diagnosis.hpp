// SPDX-License-Identifier: Apache-2.0
// What is wrong with a log before anything is fitted: units, signs, handedness, axes, clocks, and rows that nobody
// measured. A fault with one certain cure is cured; what is only likely is said.
#pragma once

#include <optional>

#include "kinfer/base/result.hpp"
#include "kinfer/estimate/continuous/model/problem.hpp"
#include "kinfer/evidence/facts/findings.hpp"
#include "kinfer/inertial/segment_motion.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer::identify {

struct LogDiagnosis {
  std::optional<InsRecording> mended;  ///< none if the recording is used as it is
  std::vector<Finding> findings{};
  InsCommonScales scales{};             ///< by which all instruments of a kind were divided
  std::vector<GyroscopeBias> biases{};  ///< told by a fit of the log, of sensors that never rest
  int bias_updates = 0;                 ///< how many fits have told them, each with the biases of the one before

  const InsRecording& of(const InsRecording& recording) const { return mended ? *mended : recording; }
};

/// Maps the axes of one of the sensors that are to be left out because they share no joint with any other, if their
/// neighbours want it: of `used`, the recording of which they are part, and of `recording`, which was diagnosed. False:
/// nothing was mapped.
bool mend_unconnected_axes(LogDiagnosis& diagnosis, const InsRecording& recording, const InsRecording& used,
                           const std::vector<std::size_t>& unconnected, int threads);

/// An error where the log cannot be used at all: specific force without gravity, Euler angles for rates.
Result<LogDiagnosis> diagnose_log(const InsRecording& recording, int threads);

}  // namespace kinfer::identify
