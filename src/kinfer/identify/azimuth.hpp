// How well the heading of a sensor is known on a body that turns about one fixed axis: its accelerometer tells where
// the axis is, but all that hangs on the body may be turned about that axis without changing any signal.
#pragma once

#include "kinfer/estimate/ins_problem.hpp"

namespace kinfer {

/// [rad] Standard deviation of the azimuth about a turning joint's axis of what hangs on the body behind it: of the
/// axis of the joint that lies farthest across, or of its point where the axes are parallel. 0 where nothing hangs on
/// it.
double azimuth_sd(const InsLayout& layout, const InsBodies& bodies, ConstMatrixRef covariance, std::size_t body);

}  // namespace kinfer
