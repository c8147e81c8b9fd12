// Which magnetic field is the Earth's: its strength and dip are learned while it stays the same; a field that leaves
// them is a disturbance and not used for heading, but not for ever (cf. Laidig and Seel 2023, section 3.4).
#pragma once

#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

struct MagneticOptions {
  double norm_tolerance = 0.1;      ///< share of the strength by which an undisturbed field may differ
  double dip_tolerance = 0.12;      ///< [rad] (7°) likewise of the dip
  double smoothing_time = 0.05;     ///< [s] of strength and dip as read
  double undisturbed_time = 0.5;    ///< [s] of agreement before the field is used (again)
  double reference_time = 20.0;     ///< [s] time constant with which the reference follows an undisturbed field
  double first_time = 5.0;          ///< [s] of turning in the same field before it becomes the first reference
  double new_time = 20.0;           ///< [s] of turning in the same other field before it becomes the reference
  double turning_rate = 0.35;       ///< [rad/s] (20 °/s) a field that travels with the sensor passes only when still
  double longest_rejection = 60.0;  ///< [s] after which a disturbed field is used all the same, with less weight
  double rejection_factor = 2.0;    ///< by which it then counts as noisier, and by which rejection time recovers faster
};

/// Streams; copyable.
struct MagneticReference {
  struct Field {
    double norm = 0.0, dip = 0.0;  ///< as the magnetometer's unit, [rad]
    double seconds = 0.0;          ///< of agreement
  };
  Field current, reference, candidate;
  bool started = false, learned = false;
  double rejected = 0.0;  ///< [s] of the rejection budget that is used up

  /// The mean field over `dt` seconds in the filter's world (z up) and the angle [rad] turned meanwhile. Returns by how
  /// much the noise of this reading counts more than usual, or 0 where it is rejected.
  double noise_factor(const Vec3& field_world, double turned, double dt, const MagneticOptions& options);

 private:
  bool agrees(const Field& known, const MagneticOptions& options) const;
  void learn(double turned, double dt, const MagneticOptions& options);
};

}  // namespace kinfer
