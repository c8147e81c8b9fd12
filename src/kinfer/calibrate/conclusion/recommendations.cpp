// SPDX-License-Identifier: Apache-2.0
// Recommendations after a calibration.
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "kinfer/calibrate/conclusion/plot_data.hpp"
#include "kinfer/calibrate/parameters/joint_excitation.hpp"

namespace kinfer::calibrate {
namespace {

void recommend_checking_outliers(const Calibration& c, std::vector<Advice>& list) {
  const auto n = c.estimate.outliers.size();
  if (n == 0) return;
  list.push_back({fmt::format("Look at the {} row{} that {} not believed", n, n == 1 ? "" : "s", n == 1 ? "is" : "are"),
                  "they were left out; a reason that is found now (a lost beam, a wrong row) saves the next set"});
}

void recommend_model_check(const Calibration& c, std::vector<Advice>& list) {
  constexpr double misfit = 4.0;  // chi2/n; the residuals are twice the instrument's noise
  if (!c.estimate.chi2_per_n || *c.estimate.chi2_per_n < misfit) return;
  list.push_back({"Look for what the model lacks: load, gears, temperature, a loose mount, or a worse instrument",
                  fmt::format("the residuals are {:.0f} times what the instrument can excuse",
                              std::sqrt(*c.estimate.chi2_per_n))});
}

void recommend_joint_ranges(const CalibrationTask& task, std::vector<Advice>& list) {
  constexpr double enough_rotation = 1.0, enough_translation = 0.1;  // [rad], [m]
  for (const JointExcitation& joint : measure_joint_excitation(task.nominal, task.data)) {
    const double range = joint.upper - joint.lower;
    if (range >= (joint.is_revolute ? enough_rotation : enough_translation)) continue;
    const std::string moved =
        joint.is_revolute ? fmt::format("{:.0f}°", range / degree) : fmt::format("{:.0f} mm", 1e3 * range);
    list.push_back({fmt::format("Add poses that move {} further", joint.name),
                    fmt::format("it moved over {} only: what it does to the tool is hardly known", moved)});
  }
}

void recommend_use(const Calibration& c, std::vector<Advice>& list) {
  if (c.usable)
    list.push_back(
        {"Put the corrected numbers to use: offsets and DH table into the controller, or joint targets through "
         "kinfer compensate",
         "the corrected model is in chain.toml, chain.urdf and the tables beside them"});
}

/// "J1=12°, J2=-40°, J3=85 mm"
std::string joint_positions_text(const Chain& chain, const VectorXd& joints) {
  std::vector<std::string> words;
  for (const Joint& joint : chain.joints)
    if (joint.is_active) {
      const double q = joints[static_cast<Eigen::Index>(words.size())];
      words.push_back(joint.name + (joint.type == JointType::prismatic ? fmt::format("={:.0f} mm", 1e3 * q)
                                                                       : fmt::format("={:.0f}°", q / degree)));
    }
  return fmt::format("{}", fmt::join(words, ", "));
}

void recommend_uncertain_region(const CalibrationTask& task, const Calibration& c, std::vector<Advice>& list) {
  constexpr double much_worse = 1.5;  // times the rms over the data's poses
  const auto& points = c.plot_data.workspace;
  if (points.empty()) return;
  const auto worst = std::ranges::max_element(points, {}, &WorkspacePoint::predicted);
  if (worst->predicted < much_worse * c.estimate.predicted_error) return;
  list.push_back({"For a better model where it is least certain, add poses near " +
                      joint_positions_text(task.nominal, worst->joints),
                  fmt::format("it expects {:.3f} mm there against {:.3f} mm over these poses", 1e3 * worst->predicted,
                              1e3 * c.estimate.predicted_error)});
}

void recommend_more_poses(const CalibrationTask& task, const Calibration& c, std::vector<Advice>& list) {
  constexpr Eigen::Index plenty = 60;
  if (task.data.rows() >= plenty) return;
  list.push_back({fmt::format("For a better model everywhere, measure {} poses more; kinfer plan --data chooses them",
                              std::max<Eigen::Index>(10, plenty - task.data.rows())),
                  fmt::format("{} poses leave the model itself {:.3f} mm uncertain; from about {} poses on the gain is "
                              "small",
                              task.data.rows(), 1e3 * c.estimate.predicted_error, plenty)});
}

}  // namespace

std::vector<Advice> make_recommendations(const CalibrationTask& task, const Calibration& calibration) {
  std::vector<Advice> list;
  recommend_use(calibration, list);
  recommend_model_check(calibration, list);
  recommend_checking_outliers(calibration, list);
  recommend_joint_ranges(task, list);
  recommend_uncertain_region(task, calibration, list);
  recommend_more_poses(task, calibration, list);
  list.push_back({"Keep ten of these poses and measure them again now and then (kinfer verify)",
                  "it tells whether this calibration still holds after a crash, a new tool or a hot summer"});
  return list;
}

}  // namespace kinfer::calibrate
