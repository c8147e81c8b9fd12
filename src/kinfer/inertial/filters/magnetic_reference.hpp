// SPDX-License-Identifier: Apache-2.0
// Detection of magnetic disturbances: the reference strength and dip are learned while the field is constant; a field
// that deviates is rejected for heading, but only for a limited time (cf. Laidig and Seel 2023, section 3.4).
#pragma once

#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

struct MagneticOptions {
  double norm_tolerance = 0.1;      ///< relative deviation of the strength allowed in an undisturbed field
  double dip_tolerance = 0.12;      ///< [rad] (7°) deviation of the dip likewise
  double smoothing_time = 0.05;     ///< [s] smoothing of measured strength and dip
  double undisturbed_time = 0.5;    ///< [s] of agreement before the field is used (again)
  double reference_time = 20.0;     ///< [s] time constant of the reference in an undisturbed field
  double first_time = 5.0;          ///< [s] of rotation in a constant field before it becomes the first reference
  double new_time = 20.0;           ///< [s] of rotation in a different constant field before it replaces the reference
  double min_rotation_rate = 0.35;  ///< [rad/s] (20 °/s) minimum; excludes fields that move with the sensor
  double max_rejection = 60.0;      ///< [s] after which a disturbed field is used nevertheless, with less weight
  double rejection_factor = 2.0;    ///< noise factor of such a field, and how much faster the rejection time recovers
};

/// Online; copyable.
struct MagneticReference {
  struct Field {
    double norm = 0.0, dip = 0.0;  ///< in the magnetometer's unit, [rad]
    double seconds = 0.0;          ///< of agreement
  };
  Field current, reference, candidate;
  bool started = false, learned = false;
  double rejected = 0.0;  ///< [s] of the rejection time used up

  /// Input: mean field over `dt` seconds in the filter's world (z up) and the rotation angle [rad] during it. Returns
  /// the factor on the noise of this measurement, or 0 if it is rejected.
  double noise_factor(const Vec3& field_world, double turned, double dt, const MagneticOptions& options);

 private:
  bool agrees(const Field& known, const MagneticOptions& options) const;
  void update_candidate(double turned, double dt, const MagneticOptions& options);
};

}  // namespace kinfer
