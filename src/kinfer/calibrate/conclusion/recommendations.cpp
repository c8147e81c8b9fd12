// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/conclusion/recommendations.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/calibrate/conclusion/thresholds.hpp"
#include "kinfer/estimate/poses/joint_excitation.hpp"

namespace kinfer::calibrate {
namespace {

using Recommendations = std::vector<CalibrationAdvice>;

void recommend_use(const Calibration& c, Recommendations& list) {
  if (c.usability != Usability::do_not_use) list.push_back({CalibrationAdviceKind::use_corrections});
}

/// All else would be drawn from a fit to faulty data.
Recommendations correct_first(const Calibration& c) {
  const auto faults = std::ranges::count_if(c.findings, invalidates_result);
  return {{CalibrationAdviceKind::correct_data, {{"faults", static_cast<int>(faults)}}}};
}

void recommend_model_check(const Calibration& c, Recommendations& list) {
  if (!c.estimate.chi2_per_n || *c.estimate.chi2_per_n < thresholds::misfit_chi2) return;
  list.push_back({CalibrationAdviceKind::check_model, {{"residual_ratio", std::sqrt(*c.estimate.chi2_per_n)}}});
}

void recommend_checking_outliers(const Calibration& c, Recommendations& list) {
  if (c.estimate.outliers.empty()) return;
  list.push_back({CalibrationAdviceKind::check_outliers, {{"rows", static_cast<int>(c.estimate.outliers.size())}}});
}

void recommend_joint_ranges(const CalibrationTask& task, Recommendations& list) {
  for (const JointExcitation& joint : measure_joint_excitation(task.nominal, task.data)) {
    const double range = joint.upper - joint.lower;
    if (range >= (joint.is_revolute ? thresholds::enough_rotation : thresholds::enough_translation)) continue;
    list.push_back({CalibrationAdviceKind::extend_joint_range,
                    {{"joint", joint.name}, {joint.is_revolute ? "range_rad" : "range_m", range}}});
  }
}

void recommend_uncertain_region(const CalibrationTask& task, const Calibration& c, Recommendations& list) {
  const auto& points = c.plot_data.workspace;
  if (points.empty()) return;
  const auto worst = std::ranges::max_element(points, {}, &WorkspacePoint::predicted);
  if (worst->predicted < thresholds::uncertain_ratio * c.estimate.predicted_error) return;
  std::vector<std::string> joints;
  std::vector<int> prismatic;
  for (const Joint& joint : task.nominal.joints)
    if (joint.is_active) {
      joints.push_back(joint.name);
      prismatic.push_back(translates(joint.type) ? 1 : 0);
    }
  list.push_back({CalibrationAdviceKind::measure_uncertain_region,
                  {{"joints", joints},
                   {"positions", std::vector<double>(worst->joints.begin(), worst->joints.end())},
                   {"prismatic", prismatic},
                   {"error_there_m", worst->predicted},
                   {"error_m", c.estimate.predicted_error}}});
}

void recommend_more_poses(const CalibrationTask& task, const Calibration& c, Recommendations& list) {
  const Eigen::Index poses = task.data.rows();
  if (poses >= thresholds::enough_poses) return;
  list.push_back({CalibrationAdviceKind::measure_more_poses,
                  {{"more", static_cast<int>(std::max(thresholds::least_more_poses, thresholds::enough_poses - poses))},
                   {"poses", static_cast<int>(poses)},
                   {"error_m", c.estimate.predicted_error},
                   {"enough", static_cast<int>(thresholds::enough_poses)}}});
}

}  // namespace

Recommendations make_recommendations(const CalibrationTask& task, const Calibration& calibration) {
  if (calibration.reason == CalibrationReason::fault_remains) return correct_first(calibration);
  Recommendations list;
  recommend_use(calibration, list);
  recommend_model_check(calibration, list);
  recommend_checking_outliers(calibration, list);
  recommend_joint_ranges(task, list);
  recommend_uncertain_region(task, calibration, list);
  recommend_more_poses(task, calibration, list);
  list.push_back({CalibrationAdviceKind::keep_verification_poses});
  return list;
}

}  // namespace kinfer::calibrate
