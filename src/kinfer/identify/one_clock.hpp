// A recording whose sensors may have clocks of their own, on one clock as well as rates alone can tell.
#pragma once

#include <limits>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/identification.hpp"
#include "kinfer/identify/refine.hpp"
#include "kinfer/inertial/segment_motion.hpp"

namespace kinfer {

struct OneClock {
  std::optional<InsRecording> moved;         ///< nothing where all readings are used as they are
  std::vector<ClockCorrection> corrections;  ///< of each sensor, all that were made so far
  Clocks trust = Clocks::checked;            ///< what the fit should make of the clocks
  /// [s] of the machine's time that is used
  double begin = -std::numeric_limits<double>::infinity(), end = std::numeric_limits<double>::infinity();

  const InsRecording& of(const InsRecording& recording) const { return moved ? *moved : recording; }
};

/// Loggers are aligned as wholes, always. A sensor is moved against its own logger only where it is late or early by
/// more than noise explains and the segments then hang together better.
OneClock on_one_clock(const InsRecording& recording, const SegmentMotionOptions& options, int threads);

/// Takes up what a fit found out about the clocks; true where it is so much that what came before the fit, order and
/// joint types, should be done anew.
bool take_up(OneClock& clock, const InsRecording& recording, const std::vector<RefinedClock>& found);

/// Goes on with some of the sensors, from `begin` to `end` [s] of the machine's time.
void narrow(OneClock& clock, const InsRecording& recording, const std::vector<std::size_t>& sensors, double begin,
            double end);

/// Says clocks that were corrected: evidence and findings.
void say_clocks(Identification& result, const OneClock& clock, const InsRecording& recording,
                const std::vector<RefinedClock>& found);

}  // namespace kinfer
