// SPDX-License-Identifier: Apache-2.0
// Sets up the continuous-time fit from a recording and initial estimates of its joints.
#pragma once

#include "kinfer/estimate/continuous/model/problem.hpp"
#include "kinfer/identify/geometry/initial_joint.hpp"
#include "kinfer/measurement/sensor_model.hpp"

namespace kinfer::identify {

struct RefinementSetup {
  InsProblem problem;
  InsUnknowns start;
  std::vector<std::size_t> first_body, last_body;  ///< of each joint: one body, or several in series
};

/// `knots`: knot spacing of the splines [s].
RefinementSetup set_up_refinement(const InsRecording& recording, const RecordedMotion& motion, const SegmentTree& tree,
                                  const std::vector<InitialJoint>& starts, const SensorModel& grade,
                                  double knot_spacing);

}  // namespace kinfer::identify
