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
  bool is_noise_raised = false;                    ///< of a sensor, to the least
};

/// `knot_spacing` of the splines [s]; `least_noise`: in units of the quietest instruments' noise, below which none of
/// this recording is taken to be; `common`: by which the recording was divided.
RefinementSetup set_up_refinement(const InsRecording& recording, const RecordedMotion& motion, const SegmentTree& tree,
                                  const std::vector<InitialJoint>& starts, const SensorModel& grade,
                                  double knot_spacing, double least_noise = 1.0, const InsCommonScales& common = {});

}  // namespace kinfer::identify
