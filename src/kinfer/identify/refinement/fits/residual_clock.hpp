// SPDX-License-Identifier: Apache-2.0
// Clock errors that remain in a synchronised recording, as the continuous-time fit estimates them.
#pragma once

#include "kinfer/measurement/ins/clock_correction.hpp"

namespace kinfer::identify {

/// How the sensors' clocks are treated.
enum class ClockTreatment {
  trusted,   ///< as synchronous
  checked,   ///< as synchronous unless the residuals contradict significantly
  estimated  ///< each with an offset and a drift relative to the reference
};

/// Residual clock error of a sensor in the synchronised recording.
struct ResidualClock {
  ClockCorrection correction;
  double offset_sd = 0.0, drift_sd = 0.0;  ///< [s], [s/s]
};

}  // namespace kinfer::identify
