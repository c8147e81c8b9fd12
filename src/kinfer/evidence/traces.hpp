// Long signals, thinned to what a screen can show without hiding a spike, and the motion as a film.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// The smallest and the largest value of each bin of consecutive samples; NaN where a bin has no finite sample.
struct Envelope {
  std::vector<double> low, high;
};

/// Bins for `samples` samples: all of equal size but the last, at most `most`.
struct Binning {
  std::size_t samples = 0;
  std::size_t size = 1;  ///< samples a bin
  std::size_t count() const { return (samples + size - 1) / size; }
};
Binning binning(std::size_t samples, std::size_t most);

Envelope envelope(std::span<const double> samples, const Binning& bins);

/// One kind of signal of one sensor: x, y, z.
struct Trace {
  std::string sensor{};
  std::string quantity{};  ///< "acceleration", "rate"
  std::string unit{};      ///< "m/s^2", "rad/s"
  std::string frame{};     ///< "ground" or "sensor"
  std::array<Envelope, 3> measured{}, predicted{}, residual{};
  double rms_measured = 0.0;                   ///< of the signal's three axes together
  double rms_fitted = 0.0, rms_holdout = 0.0;  ///< of the residual's three axes together; 0: no such rows
};

struct TimeWindow {
  double begin = 0.0, end = 0.0;  ///< [s]
};

/// The machine's motion in steps that a screen can play: angles and the root's orientation.
struct Playback {
  std::vector<double> time;                 ///< [s]
  std::vector<std::array<double, 4>> root;  ///< w x y z, root's sensor to ground: one a time, or one for all
  MatrixXd q;                               ///< dof x times, readings of Identification::chain [rad] or [m]
};

struct MotionEvidence {
  std::vector<double> time;  ///< [s] middle of each bin
  std::vector<Trace> traces;
  std::vector<TimeWindow> held_out;  ///< not fitted
  Playback playback;
};

}  // namespace kinfer
