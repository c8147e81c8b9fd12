// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/ins/clock_correction.hpp"

#include <cmath>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

bool have_equal_correction(const ClockCorrection& a, const ClockCorrection& b, const std::vector<double>& time) {
  constexpr double same = 1e-9;  // [s]
  return std::abs(a.shift_at(time.front()) - b.shift_at(time.front())) < same &&
         std::abs(a.shift_at(time.back()) - b.shift_at(time.back())) < same;
}

InsLogger apply_correction(InsLogger logger, const ClockCorrection& correction) {
  for (double& t : logger.time) t += correction.shift_at(t);
  return logger;
}

}  // namespace

bool ClockCorrection::is_none() const {
  return std::abs(offset) <= 0.0 && std::abs(drift) <= 0.0;
}

InsRecording synchronise_sensors(const InsRecording& recording, std::span<const ClockCorrection> corrections) {
  KINFER_EXPECT(corrections.size() == recording.sensors.size());
  InsRecording result{.loggers = {}, .sensors = recording.sensors, .remarks = recording.remarks};
  std::vector<std::size_t> like;  // one sensor of each new logger
  for (std::size_t s = 0; s < recording.sensors.size(); ++s) {
    const InsLogger& logger = recording.loggers[recording.sensors[s].logger];
    std::size_t at = 0;
    while (at < like.size() && (recording.sensors[like[at]].logger != recording.sensors[s].logger ||
                                !have_equal_correction(corrections[like[at]], corrections[s], logger.time)))
      ++at;
    if (at == like.size()) {
      like.push_back(s);
      result.loggers.push_back(apply_correction(logger, corrections[s]));
    }
    result.sensors[s].logger = at;
  }
  return result;
}

}  // namespace kinfer
