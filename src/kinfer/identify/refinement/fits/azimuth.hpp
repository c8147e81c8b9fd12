// SPDX-License-Identifier: Apache-2.0
// Azimuths of sub-trees about the fixed axis of the body that carries them. The accelerometer determines the position
// of such an axis, but rotating the sub-tree about it changes no signal, unless the axis is inclined or moves: then
// magnetometers tell.
#pragma once

#include "kinfer/identify/refinement/fits/refinement_fits.hpp"

namespace kinfer::identify {

/// [rad] Standard deviation of the azimuth, about the axis of `body`'s revolute joint, of the sub-tree behind the body.
/// Taken from the child joint whose axis is farthest from parallel, or from its point if all axes are parallel. 0 if
/// the body has no child.
double azimuth_sd(const InsLayout& layout, const InsBodies& bodies, ConstMatrixRef covariance, std::size_t body);

/// The fit's own steps are local, and weak evidence of an azimuth has other valleys on the circle: the fit is continued
/// from some places of it, one sub-tree after the other, and the most likely end is kept.
void search_azimuths(const RefinementTask& task, RefinementFit& fitted, const Observer& observer);

/// Adds to a fit what the magnetometers tell about azimuths that gyroscopes and accelerometers leave uncertain: the
/// sub-trees are rotated to the most likely azimuths, found on the whole circle, and where inclination or motion tells
/// something too, the fit continues with both. Magnetometers have no say in what the other instruments determine:
/// steel that moves with the machine would bend it.
void measure_azimuths(const RefinementTask& task, RefinementFit& fitted);

}  // namespace kinfer::identify
