// SPDX-License-Identifier: Apache-2.0
// Least-squares fits of points: centroid, rigid alignment, plane, circle in space.
#pragma once

#include <span>

#include "kinfer/geometry/pose.hpp"

namespace kinfer {

/// Weights may be empty.
Vec3 centroid(std::span<const Vec3> points, std::span<const double> weights = {});
/// rms distance of the points from their centroid [m]; not a number for none.
double rms_spread(std::span<const Vec3> points);

/// a_T_b that minimises Σ wᵢ |aᵢ − a_T_b bᵢ|² (Kabsch 1976, by Horn's quaternion, so never a reflection).
/// At least 3 points that are not on a line, else the rotation about that line is arbitrary. Weights may be empty.
Pose align_points(std::span<const Vec3> a, std::span<const Vec3> b, std::span<const double> weights = {});

/// Chordal mean: the rotation R that minimises Σ |Rᵢ − R|² (Frobenius). With Rᵢ = Aᵢ Bᵢᵀ it maps the Bᵢ to the Aᵢ.
Mat3 mean_rotation(std::span<const Mat3> rotations);

struct PlaneFit {
  Vec3 point = Vec3::Zero();    ///< centroid
  Vec3 normal = Vec3::UnitZ();  ///< unit
  double rms = 0.0;             ///< [m] distance of the points from the plane
};
PlaneFit fit_plane(std::span<const Vec3> points);

struct CircleFit {
  Vec3 center = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  ///< unit; from the first point to the later ones by the right-hand rule
  double radius = 0.0;          ///< [m]
  double rms = 0.0;             ///< [m] distance of the points from the circle
};
/// Plane fit, then the geometric circle in it (Gauss-Newton from Kåsa's algebraic one). At least 3 points.
CircleFit fit_circle(std::span<const Vec3> points);

}  // namespace kinfer
