// SPDX-License-Identifier: Apache-2.0
// Each draw has its own true robot, noise and random poses, and is evaluated without noise at 1000 random poses.
#include <fmt/format.h>

#include "kinfer/calibrate/terms/approximate_masses.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"
#include "kinfer/simulate/pose_set.hpp"
#include "studies/support/chains.hpp"
#include "trials.hpp"

namespace kinfer::study::planning_study {
using namespace calibrate;
using namespace plan;
namespace {

constexpr Instrument tracker{.sigma = 10e-6, .sigma_angle = 0.0, .ppm = 5};
constexpr int plans = 4;  // for each criterion, with different seeds, to average out chance

/// Non-geometric errors of the true robot.
struct Beyond {
  const char* words;
  double compliance = 0.0;  // [rad/(N m)] mean of the revolute joints
  double gear = 0.0;        // [rad] sd of the sine and cosine of orders 1 and 2
};
constexpr Beyond beyond_geometry[] = {{"rigid"}, {"compliant", 2e-6, 0.0}, {"compliant with gears", 2e-6, 30e-6}};

/// Masses and compliances differ from those that calibrate would assume.
void add_non_geometric_errors(Chain& truth, const Beyond& beyond, Rng rng) {
  if (beyond.compliance > 0.0) truth = with_approximate_masses(truth);
  for (PointMass& mass : truth.masses) mass.mass *= rng.uniform(0.5, 1.8), mass.com *= rng.uniform(0.7, 1.3);
  for (Joint& joint : truth.joints) {
    if (joint.type != JointType::revolute) continue;
    joint.compliance = beyond.compliance * rng.uniform(0.3, 1.7);
    if (beyond.gear == 0.0) continue;
    for (const double order : {1.0, 2.0})
      joint.harmonics.push_back({order, beyond.gear * rng.normal(), beyond.gear * rng.normal()});
  }
}

struct Robot {
  const char* words;
  Chain nominal;
  bool frame_is_unknown = false;
};

std::vector<Robot> robots() {
  const auto file = [](const char* path) { return read_robot_toml(path).value().chain; };
  Chain six = file("examples/robot6/robot.toml");
  six.tool.xyz = Vec3(0.03, 0.02, 0.1);
  return {{"UR10", file("data/ur10/robot.toml")},
          {"UR10-like, tool off the last axis", ur10_like()},
          {"six axes of paper 2, unknown tracker frame", six, true},
          {"SCARA", scara()},
          {"seven axes", seven_axes()}};
}

Chain true_robot(const Robot& robot, const Beyond& beyond, int draw) {
  Chain truth = with_random_errors(robot.nominal, {}, Rng(100).stream(draw));
  if (robot.frame_is_unknown) truth.base = Frame::from_pose(Pose::from_xyz_rpy({1.2, -2.5, 0.35}, {0.02, -0.03, 2.3}));
  add_non_geometric_errors(truth, beyond, Rng(77).stream(draw));
  return truth;
}

std::vector<MatrixXd> planned(const Robot& robot, const NamedCriterion& by) {
  PlanTask task;
  task.nominal = robot.nominal, task.instrument = tracker;
  std::vector<MatrixXd> found;
  for (int seed = 1; seed <= plans; ++seed) {
    const PosePlan plan = plan_poses(task, {.poses = poses, .criterion = by.criterion}, Rng(seed)).value();
    found.push_back(plan.joints);
    if (seed == 1 && plan.rms_lower_bound > 0.0)
      fmt::print(
          "{}: expected rms {:.4f} mm, worst point {:.4f}; lower bound of the rms for any choice {:.4f}; random "
          "{:.4f}\n",
          robot.words, 1e3 * plan.expected.rms, 1e3 * plan.expected.worst, 1e3 * plan.rms_lower_bound,
          1e3 * plan.random.rms);
  }
  return found;
}

std::string one_robot(const Robot& robot) {
  const MatrixXd test_joints = draw_poses(robot.nominal, {}, 1000, Rng(200)).value();
  std::vector<std::vector<MatrixXd>> chosen;
  for (const NamedCriterion& by : all_criteria) chosen.push_back(planned(robot, by));
  std::string table;
  for (const Beyond& beyond : beyond_geometry)
    for (const Fitting fitting : all_fittings) {
      const auto evaluated = [&](int draw, const MatrixXd& q) {
        const Chain truth = true_robot(robot, beyond, draw);
        const CalibrationTask task{.nominal = robot.nominal, .tolerances = {}, .instrument = tracker, .data = {}};
        return errors_of(task, fitting, simulate_points(truth, q, tracker, Rng(300).stream(draw)),
                         simulate_points(truth, test_joints));
      };
      const Errors random = medians_of(
          [&](int draw) { return evaluated(draw, draw_poses(robot.nominal, {}, poses, Rng(7).stream(draw)).value()); });
      const std::string set = fmt::format("\"{}, {}\"", robot.words, beyond.words);
      table += row(set, fitting, "random", random, random);
      for (std::size_t k = 0; k < chosen.size(); ++k)
        table += row(set, fitting, all_criteria[k].name,
                     medians_of([&](int draw) { return evaluated(draw, chosen[k][draw % plans]); }), random);
    }
  return table;
}

}  // namespace

std::string simulated_robots() {
  std::string table;
  for (const Robot& robot : robots()) table += one_robot(robot);
  return table;
}

}  // namespace kinfer::study::planning_study
