// The last word on the geometry: the continuous-time fit of the whole tree over the whole recording, with honest
// standard deviations.
#pragma once

#include "kinfer/estimate/ins_fit.hpp"
#include "kinfer/identify/joint_start.hpp"
#include "kinfer/identify/refined_joint.hpp"
#include "kinfer/measurement/machine_facts.hpp"
#include "kinfer/measurement/sensor_model.hpp"

namespace kinfer {

struct RefineOptions {
  std::optional<SensorModel> grade{};  ///< what the sensors are worth; without it judged from the recording
  InsFitOptions fit{};
  double knots = 0.1;    ///< [s] between the knots of the splines
  MachineFacts facts{};  ///< what else is known
};

struct Refinement {
  std::vector<RefinedJoint> joints;  ///< in the order of the starts; angle 0 is where the recording begins
  InsFit fit;
  std::vector<InsNoise> noise;     ///< of each sensor, as its residuals show it
  std::vector<InsNoise> least;     ///< of each sensor, what it has even where the chain is right
  MatrixXd covariance;             ///< of the border's unknowns
  std::string grade;               ///< that was used
  std::vector<FoundPlace> places;  ///< of the facts
};

/// `starts`: one for each segment but the root, parents before children.
Result<Refinement> refine(const InsRecording& recording, const RecordedMotion& motion, const SegmentTree& tree,
                          const std::vector<JointStart>& starts, const RefineOptions& options,
                          const Observer& observer = {});

}  // namespace kinfer
