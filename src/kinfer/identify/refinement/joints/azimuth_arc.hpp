// SPDX-License-Identifier: Apache-2.0
// A joint whose azimuth about the axis of the body that carries it is uncertain: axis and point lie on an arc about
// that axis, of which a covariance holds the tangent only.
#pragma once

#include <optional>

#include "kinfer/estimate/continuous/model/azimuth.hpp"

namespace kinfer::identify {

struct AzimuthArc {
  double azimuth_sd = 0.0;  ///< [rad]
  double radius = 0.0;      ///< [m] of the point that is reported: that of the axis nearest to the child's sensor
  MatrixXd beyond_tangent;  ///< to be added to the covariance of the body's unknowns
};

/// Whether the azimuth is that of its prior: any place on the circle is possible.
bool is_open(const AzimuthArc& arc);

/// Whether a place on the open circle tells nothing of the joint's point.
bool is_point_lost(const AzimuthArc& arc);

/// Towards the centre of the arc, E (1 − cos)² of a normally distributed azimuth. Where it is open, so that the place
/// is uniform on the circle, E |x − x₀|² = 2 r². `covariance`: of the global parameters. Empty where body `child` is
/// not carried by a body with an INS and a revolute joint of its own.
std::optional<AzimuthArc> azimuth_arc(const InsLayout& layout, const InsBodies& bodies, ConstMatrixRef covariance,
                                      std::size_t child);

}  // namespace kinfer::identify
