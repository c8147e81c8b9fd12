// A recording and first guesses of its joints as a problem of the continuous-time fit.
#pragma once

#include "kinfer/estimate/ins_problem.hpp"
#include "kinfer/identify/joint_start.hpp"
#include "kinfer/measurement/sensor_model.hpp"

namespace kinfer {

struct RefineSetup {
  InsProblem problem;
  InsUnknowns start;
  std::vector<std::size_t> first_body, last_body;  ///< of each joint: one body, or two or three behind each other
};

/// `knots` [s] between the knots of the splines.
RefineSetup refine_setup(const InsRecording& recording, const RecordedMotion& motion, const SegmentTree& tree,
                         const std::vector<JointStart>& starts, const SensorModel& grade, double knots);

}  // namespace kinfer
