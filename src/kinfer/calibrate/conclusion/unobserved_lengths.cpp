// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/conclusion/unobserved_lengths.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/calibrate/conclusion/thresholds.hpp"
#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/calibrate/validation/validation_errors.hpp"
#include "kinfer/estimate/poses/joint_excitation.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"

namespace kinfer::calibrate {
namespace {

using Eigen::Index;

bool prismatic_joint_moved(const CalibrationTask& task) {
  return std::ranges::any_of(measure_joint_excitation(task.nominal, task.data), [](const JointExcitation& joint) {
    return !joint.is_revolute && joint.upper - joint.lower >= thresholds::enough_translation;
  });
}

}  // namespace

double relative_size_sd(const Estimate& estimate, const PoseSet& data) {
  const EvaluatedPoses at = evaluate_poses(estimate.chain, estimate.parameters, data, Derivative::yes);
  Vec3 centre = Vec3::Zero();
  for (const Pose& pose : at.pose) centre += pose.position / static_cast<double>(at.pose.size());
  VectorXd change_of_size = VectorXd::Zero(estimate.covariance.rows());
  double squares = 0.0;
  // The mean of d drops out: the arms add up to zero.
  for (std::size_t i = 0; i < at.pose.size(); ++i) {
    const Vec3 arm = at.pose[i].position - centre;
    change_of_size += at.twists[i].topRows<3>().transpose() * arm;
    squares += arm.squaredNorm();
  }
  if (!(squares > 0.0)) return 0.0;
  return std::sqrt(std::max(0.0, change_of_size.dot(estimate.covariance * change_of_size))) / squares;
}

std::optional<UnobservedLengths> find_unobserved_lengths(const CalibrationTask& task, const Estimate& estimate) {
  if (lengths_are_measured(task)) return std::nullopt;
  const double sd = relative_size_sd(estimate, task.data);
  if (!primary_measurement_kind(task.data)) return UnobservedLengths{UnobservedLength::all_lengths, sd};
  if (prismatic_joint_moved(task)) return std::nullopt;
  return UnobservedLengths{UnobservedLength::size, sd};
}

}  // namespace kinfer::calibrate
