// SPDX-License-Identifier: Apache-2.0
// Long signals decimated for display without losing a spike (min/max envelopes), and the motion as a joint trajectory.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// The smallest and the largest value of each bin of consecutive samples; NaN where a bin has no finite sample.
struct Envelope {
  std::vector<double> low, high;
};

/// `samples` samples in bins of equal size; the last may be shorter. binning() makes at most `max_bins`.
struct Binning {
  std::size_t samples = 0;
  std::size_t size = 1;  ///< samples per bin
  std::size_t count() const { return (samples + size - 1) / size; }
};
Binning binning(std::size_t samples, std::size_t max_bins);

Envelope envelope(std::span<const double> samples, const Binning& bins);

enum class TraceQuantity { acceleration, angular_velocity };
std::string_view name(TraceQuantity quantity);  ///< "acceleration", "rate"
std::string_view unit(TraceQuantity quantity);  ///< "m/s^2", "rad/s"

enum class TraceFrame { world, sensor };
std::string_view name(TraceFrame frame);  ///< "ground", "sensor"

/// One kind of signal of one sensor: x, y, z.
struct Trace {
  std::string sensor{};
  TraceQuantity quantity = TraceQuantity::acceleration;
  TraceFrame frame = TraceFrame::world;
  std::array<Envelope, 3> measured{}, predicted{}, residual{};
  double rms_measured = 0.0;                   ///< of the vector norm
  double rms_fitted = 0.0, rms_holdout = 0.0;  ///< likewise of the residual; 0: no such rows
};

struct TimeWindow {
  double begin = 0.0, end = 0.0;  ///< [s]
};

/// The machine's motion for animation: joint positions and the orientation of the root.
struct MachineTrajectory {
  std::vector<double> time;                 ///< [s]
  std::vector<std::array<double, 4>> root;  ///< w x y z, world_R_root sensor: one per time, or one for all
  MatrixXd q;                               ///< dof x times, joint positions of Identification::chain [rad] or [m]
};

struct MotionEvidence {
  std::vector<double> time;  ///< [s] middle of each bin
  std::vector<Trace> traces;
  std::vector<TimeWindow> held_out;  ///< not fitted
  MachineTrajectory trajectory;
};

}  // namespace kinfer
