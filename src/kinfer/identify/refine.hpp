// The last word on the geometry: the continuous-time fit of the whole tree over the whole recording, with honest
// standard deviations.
#pragma once

#include "kinfer/estimate/ins_fit.hpp"
#include "kinfer/identify/held_out.hpp"
#include "kinfer/identify/joint_start.hpp"
#include "kinfer/identify/refined_joint.hpp"
#include "kinfer/measurement/clocks.hpp"
#include "kinfer/measurement/machine_facts.hpp"
#include "kinfer/measurement/sensor_model.hpp"

namespace kinfer {

/// Whether the sensors' clocks are believed.
enum class Clocks {
  trusted,   ///< they agree
  checked,   ///< they agree unless the residuals say otherwise, beyond doubt
  estimated  ///< each has an offset and a drift against the reference
};

struct RefineOptions {
  std::optional<SensorModel> grade{};  ///< what the sensors are worth; without it judged from the recording
  InsFitOptions fit{};
  double knots = 0.0;    ///< [s] between the knots of the splines; 0: as the motion asks for (motion_knots)
  MachineFacts facts{};  ///< what else is known
  Clocks clocks = Clocks::checked;
  bool hold_out = true;  ///< fit once more without some windows, to tell how well the chain predicts
};

/// What is left of a sensor's clock error once the recording is on one clock.
struct RefinedClock {
  ClockCorrection correction;
  double offset_sd = 0.0, drift_sd = 0.0;  ///< [s], [s/s]
};

struct Refinement {
  std::vector<RefinedJoint> joints;  ///< in the order of the starts; angle 0 is where the recording begins
  InsFit fit;
  std::vector<InsNoise> noise;         ///< of each sensor, as its residuals show it
  std::vector<InsNoise> least;         ///< of each sensor, what it has even where the chain is right
  MatrixXd covariance;                 ///< of the border's unknowns
  std::string grade;                   ///< that was used
  std::vector<FoundPlace> places;      ///< of the facts
  double knots = 0.0;                  ///< [s] that were used for all of the motion
  double cutoff = 0.0;                 ///< [Hz] below which the motion was believed; 0: all of it was
  std::vector<RefinedClock> clocks{};  ///< one a sensor; none where the clocks were right
  HeldOut held_out{};                  ///< empty where the recording is too short or nobody asked
};

/// `starts`: one for each segment but the root, parents before children.
Result<Refinement> refine(const InsRecording& recording, const RecordedMotion& motion, const SegmentTree& tree,
                          const std::vector<JointStart>& starts, const RefineOptions& options,
                          const Observer& observer = {});

}  // namespace kinfer
