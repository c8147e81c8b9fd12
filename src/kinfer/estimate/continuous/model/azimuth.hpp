// SPDX-License-Identifier: Apache-2.0
// Azimuth of a sub-tree: its rotation about the axis of the body that carries it. If that axis keeps its direction in
// space and is vertical, the rotation changes no gyroscope and no accelerometer signal: only a magnetometer, a slope or
// a moving base tells it.
#pragma once

#include "kinfer/estimate/continuous/model/problem.hpp"

namespace kinfer {

/// [m], or sine of the angle between axes: shorter levers do not show an azimuth. Data not recorded.
inline constexpr double min_azimuth_lever = 0.1;

/// The joints of which an azimuth is unknown: all joints that start on a body with an INS and a revolute joint of its
/// own.
std::vector<InsAzimuth> azimuths_of(const InsBodies& bodies);

/// What shows the azimuth, in the frame of `azimuth.body` and across its axis: the direction of the child's axis or, if
/// it is nearly parallel, the arm [m] from the body's own joint to the child's. Zero if both are too short.
Vec3 azimuth_direction(const InsBodies& bodies, const InsAzimuth& azimuth);

/// [rad] Rotation about the body's axis from `direction` to the present azimuth_direction.
double azimuth_from(const Vec3& direction, const InsBodies& bodies, const InsAzimuth& azimuth);

/// Its derivative by the global parameters.
VectorXd azimuth_gradient(const InsLayout& layout, const InsBodies& bodies, const InsAzimuth& azimuth);

/// Rotates the sub-tree behind `azimuth.child` by `angle` [rad] about the axis of `azimuth.body`.
void rotate_azimuth(InsBodies& bodies, const InsAzimuth& azimuth, double angle);

}  // namespace kinfer
