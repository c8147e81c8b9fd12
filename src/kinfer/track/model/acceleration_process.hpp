// SPDX-License-Identifier: Apache-2.0
// The acceleration of a joint or a base as a random process.
#pragma once

namespace kinfer::track {

/// First-order Gauss-Markov (Ornstein-Uhlenbeck) acceleration.
struct AccelerationProcess {
  double sd = 0.0;           ///< [rad/s²] or [m/s²] of the acceleration itself
  double time = 0.5;         ///< [s] its correlation time
  bool is_measured = false;  ///< by accelerometers, while nothing measures the velocity

  double density() const { return 2.0 * sd * sd / time; }
};

}  // namespace kinfer::track
