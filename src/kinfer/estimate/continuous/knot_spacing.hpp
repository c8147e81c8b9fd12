// SPDX-License-Identifier: Apache-2.0
// Knot spacing required by a recording's motion, chosen from the measurements only, before any chain is known: a fast
// arm must not look like a model error, and a slow machine should not cost more than necessary.
#pragma once

#include <span>

#include "kinfer/linalg/types.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"
#include "kinfer/measurement/sensor_model.hpp"

namespace kinfer {

constexpr double widest_knot_spacing = 0.1;  ///< [s] relative error 1e-3 at 2.5 Hz

/// [s] The same where a machine vibrates: relative error 1e-3 at 0.6 Hz.
constexpr double widest_knot_spacing_in_vibration = 0.4;

/// [angular velocity, specific force] of the rows from `first` to before `end`, one a row; NaN where either is missing
/// or clipped.
MatrixXd measurement_rows(const InsSensor& sensor, std::span<const double> time, std::size_t first, std::size_t end);

/// [s] between knots, from `widest_knot_spacing` down to 0.025 s in steps of √2.
///
/// A spline is fitted to each sensor's measurements, from wide knots to fine, until knots finer by √2 hardly reduce the
/// residual: then the residual is noise, or vibration too fast to follow. The result is finer by √2 once more, because
/// products of splines (centripetal acceleration) have twice their frequency. If an interval would hold too few samples
/// to separate motion from noise, the knots stay wider. Long recordings are judged by their two most active minutes.
double select_knot_spacing(const InsRecording& recording);

/// The same, but up to `widest_knot_spacing_in_vibration` where the machine vibrates, its measurements scattering about
/// smooth motion by far more than the sensors' noise (`grade`), and wider knots leave no more of them. Splines that
/// follow a vibration take the bending of the machine for motion of its joints: on a slow arm (KUKA iiwa, 15-50 Hz) a
/// length of 400 mm came out as 876 mm with knots of 0.1 s and as 409 mm with 0.4 s.
double select_knot_spacing(const InsRecording& recording, const SensorModel& grade);

}  // namespace kinfer
