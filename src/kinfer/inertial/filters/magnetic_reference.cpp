// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/filters/magnetic_reference.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer {
namespace {

void low_pass(MagneticReference::Field& field, const MagneticReference::Field& target, double dt,
              double time_constant) {
  const double gain = dt / (time_constant + dt);
  field.norm += gain * (target.norm - field.norm);
  field.dip += gain * (target.dip - field.dip);
}

}  // namespace

bool MagneticReference::agrees(const Field& known, const MagneticOptions& options) const {
  return std::abs(current.norm - known.norm) < options.norm_tolerance * known.norm &&
         std::abs(current.dip - known.dip) < options.dip_tolerance;
}

void MagneticReference::update_candidate(double turned, double dt, const MagneticOptions& options) {
  if (!agrees(candidate, options)) {
    candidate = current;
    candidate.seconds = 0.0;
    return;
  }
  low_pass(candidate, current, dt, options.reference_time);
  if (turned > options.min_rotation_rate * dt) candidate.seconds += dt;
  const double needed = learned ? options.new_time : options.first_time;
  const bool reference_needed = !learned || reference.seconds <= 0.0;
  if (candidate.seconds < needed || !reference_needed) return;
  reference = {candidate.norm, candidate.dip, options.undisturbed_time};
  learned = true;
}

double MagneticReference::noise_factor(const Vec3& field_world, double turned, double dt,
                                       const MagneticOptions& options) {
  const double norm = field_world.norm();
  if (!(norm > 0.0)) return 0.0;
  const Field measured{norm, -std::asin(std::clamp(field_world.z() / norm, -1.0, 1.0)), 0.0};
  if (!started) current = measured, started = true;
  low_pass(current, measured, dt, options.smoothing_time);
  if (learned && agrees(reference, options)) {
    reference.seconds += dt;
    if (reference.seconds >= options.undisturbed_time) low_pass(reference, current, dt, options.reference_time);
  } else {
    reference.seconds = 0.0;
  }
  update_candidate(turned, dt, options);
  if (!learned || reference.seconds >= options.undisturbed_time) {
    rejected = std::max(0.0, rejected - options.rejection_factor * dt);
    return 1.0;
  }
  if (rejected >= options.max_rejection) return options.rejection_factor;
  rejected += dt;
  return 0.0;
}

}  // namespace kinfer
