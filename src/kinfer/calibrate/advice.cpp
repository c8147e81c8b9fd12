// What to do next after a calibration.
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "kinfer/calibrate/excitation.hpp"
#include "kinfer/calibrate/picture.hpp"

namespace kinfer {
namespace {

void look_at_unbelieved_rows(const Calibration& c, std::vector<Advice>& list) {
  const auto n = c.estimate.outliers.size();
  if (n == 0) return;
  list.push_back({fmt::format("Look at the {} row{} that {} not believed", n, n == 1 ? "" : "s", n == 1 ? "is" : "are"),
                  "they were left out; a reason that is found now (a lost beam, a wrong row) saves the next set"});
}

void find_what_is_missing(const Calibration& c, std::vector<Advice>& list) {
  constexpr double misfit = 4.0;  // chi2/n; the residuals are twice what the instrument excuses
  if (!c.estimate.chi2_per_n || *c.estimate.chi2_per_n < misfit) return;
  list.push_back({"Look for what the model lacks: load, gears, temperature, a loose mount, or a worse instrument",
                  fmt::format("the residuals are {:.0f} times what the instrument can excuse",
                              std::sqrt(*c.estimate.chi2_per_n))});
}

void move_idle_joints(const CalibrateTask& task, std::vector<Advice>& list) {
  constexpr double enough_turn = 1.0, enough_slide = 0.1;  // [rad], [m]
  for (const JointExcitation& joint : joint_excitation(task.nominal, task.data)) {
    const double range = joint.highest - joint.lowest;
    if (range >= (joint.turns ? enough_turn : enough_slide)) continue;
    const std::string moved =
        joint.turns ? fmt::format("{:.0f}°", range / degree) : fmt::format("{:.0f} mm", 1e3 * range);
    list.push_back({fmt::format("Add poses that move {} further", joint.name),
                    fmt::format("it moved over {} only: what it does to the tool is hardly known", moved)});
  }
}

void put_it_to_use(const Calibration& c, std::vector<Advice>& list) {
  if (c.use)
    list.push_back(
        {"Put the corrected numbers to use: offsets and DH table into the controller, or joint targets through "
         "kinfer compensate",
         "the corrected model is in chain.toml, chain.urdf and the tables beside them"});
}

/// "J1=12°, J2=-40°, J3=85 mm"
std::string reading_in_words(const Chain& chain, const VectorXd& joints) {
  std::vector<std::string> words;
  for (const Joint& joint : chain.joints)
    if (joint.has_reading) {
      const double q = joints[static_cast<Eigen::Index>(words.size())];
      words.push_back(joint.name + (joint.type == JointType::prismatic ? fmt::format("={:.0f} mm", 1e3 * q)
                                                                       : fmt::format("={:.0f}°", q / degree)));
    }
  return fmt::format("{}", fmt::join(words, ", "));
}

void measure_where_it_is_uncertain(const CalibrateTask& task, const Calibration& c, std::vector<Advice>& list) {
  constexpr double much_worse = 1.5;  // times the rms over the data's poses
  const auto& points = c.picture.workspace;
  if (points.empty()) return;
  const auto worst = std::ranges::max_element(points, {}, &WorkspacePoint::predicted);
  if (worst->predicted < much_worse * c.estimate.predicted_error) return;
  list.push_back(
      {"For a better model where it is least certain, add poses near " + reading_in_words(task.nominal, worst->joints),
       fmt::format("it expects {:.3f} mm there against {:.3f} mm over these poses", 1e3 * worst->predicted,
                   1e3 * c.estimate.predicted_error)});
}

void measure_more_poses(const CalibrateTask& task, const Calibration& c, std::vector<Advice>& list) {
  constexpr Eigen::Index plenty = 60;
  if (task.data.rows() >= plenty) return;
  list.push_back({fmt::format("For a better model everywhere, measure {} poses more; kinfer plan --data chooses them",
                              std::max<Eigen::Index>(10, plenty - task.data.rows())),
                  fmt::format("{} poses leave the model itself {:.3f} mm uncertain; from about {} poses on the gain is "
                              "small",
                              task.data.rows(), 1e3 * c.estimate.predicted_error, plenty)});
}

}  // namespace

std::vector<Advice> calibration_advice(const CalibrateTask& task, const Calibration& calibration) {
  std::vector<Advice> list;
  put_it_to_use(calibration, list);
  find_what_is_missing(calibration, list);
  look_at_unbelieved_rows(calibration, list);
  move_idle_joints(task, list);
  measure_where_it_is_uncertain(task, calibration, list);
  measure_more_poses(task, calibration, list);
  list.push_back({"Keep ten of these poses and measure them again now and then (kinfer verify)",
                  "it tells whether this calibration still holds after a crash, a new tool or a hot summer"});
  return list;
}

}  // namespace kinfer
