// SPDX-License-Identifier: Apache-2.0
// What the other sensors of a machine say of a correction: the segment tree gets shorter with a true one.
#pragma once

#include <vector>

#include "kinfer/identify/diagnosis/mended_log.hpp"

namespace kinfer::identify {

/// [nats per row] of the segment tree; infinite if there is none.
double tree_length(const InsRecording& recording, int threads);

/// The minute of a recording in which a sensor rotates most.
InsRecording busiest_minute(const InsRecording& recording, std::size_t sensor);

/// Other axes of one sensor.
struct AxesCandidate {
  InsSensor sensor;             ///< with these axes
  double log_likelihood = 0.0;  ///< [nats] of its own instruments
};

struct AxesChoice {
  std::size_t candidate = 0;
  std::vector<double> log_likelihood;  ///< [nats] of each candidate, of its own instruments and of the segment tree

  double tree_gain = 0.0;  ///< [nats per row] by which the segment tree is shorter than with the first; NaN: unknown

  double lead() const;  ///< [nats] over the next one
  double gain() const { return log_likelihood[candidate] - log_likelihood.front(); }
};

/// The candidate that is likeliest to a sensor's own instruments and its neighbours together, over the minute in which
/// it rotates most. A sensor's own instruments suppose that it circles about one joint, which quick drives contradict;
/// its neighbours suppose nothing of its motion, but are silent where hardly anything tilts.
AxesChoice choose_axes(const InsRecording& recording, std::size_t sensor, const std::vector<AxesCandidate>& candidates,
                       int threads);

}  // namespace kinfer::identify
