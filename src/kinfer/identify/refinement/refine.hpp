// SPDX-License-Identifier: Apache-2.0
// The final geometry: continuous-time fit of the whole tree over the whole recording, with standard deviations that
// include model errors.
#pragma once

#include "kinfer/estimate/continuous/solver/batch_fit.hpp"
#include "kinfer/evidence/facts/findings.hpp"
#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/identify/geometry/initial_joint.hpp"
#include "kinfer/identify/handover/named_zero.hpp"
#include "kinfer/identify/refinement/fits/residual_clock.hpp"
#include "kinfer/identify/refinement/held_out.hpp"
#include "kinfer/identify/refinement/joints/refined_joint.hpp"
#include "kinfer/measurement/machine_measurements.hpp"
#include "kinfer/measurement/sensor_model.hpp"

namespace kinfer::identify {

/// Where the fit begins.
enum class StartSource {
  pairs,   ///< each joint from its two sensors alone
  search,  ///< each revolute joint as the search of its link found it
  known    ///< each joint as in RefinementOptions::known
};

/// Whether kinematic loops are searched and closed in the fit.
enum class LoopTreatment { closed, open };

struct RefinementOptions {
  std::optional<SensorModel> grade{};  ///< sensor grade; without it estimated from the recording
  InsFitOptions fit{};
  double knot_spacing = 0.0;    ///< [s] knot spacing of the splines; 0: chosen from the motion (motion_knots)
  InsCommonScales common{};     ///< by which the recording was divided
  MachineMeasurements facts{};  ///< additional knowledge: touches, tape lengths, surveyed points
  ClockTreatment clocks = ClockTreatment::checked;
  StartSource start = StartSource::pairs;  ///< of refine_geometry
  LoopTreatment loops = LoopTreatment::closed;
  std::vector<NamedZero> zeros{};        ///< of joint positions; else each is 0 where the recording begins
  std::optional<TrackingModel> known{};  ///< the machine as identified before: its structure is kept
  bool hold_out = true;                  ///< fit once more without some time windows, to test the chain's predictions
};

struct Refinement {
  std::vector<RefinedJoint>
      joints;  ///< in the order of the starts; joint position 0 is where the recording begins or as named
  InsFit fit;
  std::vector<InsNoise> noise;           ///< of each sensor, estimated from its residuals
  std::vector<InsNoise> noise_floor;     ///< of each sensor, its noise floor: without any model error
  MatrixXd covariance;                   ///< of the global parameters
  std::string grade;                     ///< sensor grade that was used
  std::vector<PointEstimate> places;     ///< points that the facts name
  double knot_spacing = 0.0;             ///< [s] knot spacing that was used for the motion at full bandwidth
  double cutoff = 0.0;                   ///< [Hz] upper limit of the passband that was used; 0: full bandwidth
  std::vector<ResidualClock> clocks{};   ///< one a sensor; empty where the clocks agree
  std::vector<LoopEstimate> loops{};     ///< closed in the fit
  double negative_log_likelihood = 0.0;  ///< of the fit at full bandwidth; compares fits of one recording
  std::vector<Finding> findings{};       ///< about instruments that deviate from their grade
  HeldOut held_out{};                    ///< empty where the recording is too short or hold_out is false
  TrackingModel tracking{};
};

/// `starts`: one for each segment but the root, parents before children.
Result<Refinement> refine(const InsRecording& recording, const RecordedMotion& motion, const SegmentTree& tree,
                          const std::vector<InitialJoint>& starts, const RefinementOptions& options,
                          const Observer& observer = {});

}  // namespace kinfer::identify
