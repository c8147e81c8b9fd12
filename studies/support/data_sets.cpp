// SPDX-License-Identifier: Apache-2.0
#include "studies/support/data_sets.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <functional>

#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"
#include "studies/support/chains.hpp"
#include "studies/support/files.hpp"
#include "support/instruments.hpp"

namespace kinfer::study {
using namespace calibrate;
using namespace test;
namespace {

CalibrationTask measured_task(const Chain& chain, const PoseSet& data) {
  return {chain, {}, std::nullopt, data};
}

CalibrationTask case_task(const std::string& folder) {
  const auto robot = read_robot_toml(folder + "/robot.toml").value();
  return {robot.chain, robot.tolerances, robot.instrument, read_pose_set(folder + "/poses.csv", robot.chain).value()};
}

/// Kinds of error beyond geometry: bit k of `kind` is the k-th of them. The last two are unknown to the model.
NamedTask simulated_task(int seed) {
  constexpr int kinds = 7;
  Rng rng(1000 + seed);
  Chain nominal = seed % 3 == 0 ? nominal_robot() : seed % 3 == 1 ? ur10_like() : seven_axes();
  Chain truth = with_random_errors(nominal, {}, Rng(seed));
  const auto dof = static_cast<int>(truth.joints.size());
  std::vector<bool> has(kinds);
  for (int k = 0; k < kinds; ++k) has[k] = seed % 6 != 0 && rng.uniform() < 0.35;
  for (int j = 0; j < dof; ++j) {
    Joint& joint = truth.joints[j];
    if (has[0]) joint.gain += 1e-4 * rng.normal();
    if (has[1])
      joint.harmonics = {{1.0, 1e-4 * rng.normal(), 1e-4 * rng.normal()},
                         {2.0, 5e-5 * rng.normal(), 5e-5 * rng.normal()}};
    if (has[2]) joint.compliance = 2e-6 * std::abs(rng.normal());
    if (has[3]) joint.torque_compliance = 2e-6 * std::abs(rng.normal());
    if (has[4]) joint.backlash = 5e-5 * std::abs(rng.normal());
    if (has[5]) joint.harmonics.push_back({5.0, 5e-5 * rng.normal(), 5e-5 * rng.normal()});
  }
  if (has[2])
    truth.masses = {{1, Vec3(0.3, 0, 0.1), 25.0}, {2, Vec3(0.1, 0, 0.1), 15.0}, {dof - 1, Vec3(0, 0, 0.05), 5.0}};
  if (seed % 2 == 0) nominal.masses = truth.masses;
  constexpr int counts[] = {40, 60, 100, 150, 300, 600, 2000};
  PoseSet data =
      with_approach(readings_of(measured(truth, {.poses = counts[seed % 7], .instrument = noise_free}, seed + 7)));
  if (has[3] || seed % 5 == 0) {
    data.torques = MatrixXd::Zero(dof, data.rows());
    for (double& torque : data.torques.reshaped()) torque = 50.0 * rng.normal();
  }
  const Instrument instrument{.sigma = 20e-6, .sigma_angle = 1e-5, .ppm = 5.0};
  measure_points(data, truth, instrument, Rng(seed + 9));
  if (has[6])  // a base that yields with the reach: no term has this form
    for (PointMeasurement& point : data.points)
      point.position.z() -= 1e-4 * point.position.head<2>().norm() * std::abs(point.position.x());
  NamedTask named{fmt::format("simulated_{:02}", seed), {nominal, {}, instrument, data}};
  if (has[5] || has[6]) return named;
  constexpr const char* terms[] = {"gains", "gear", "gravity", "torques", "backlash"};
  for (int k = 0; k < 5; ++k)
    if (has[k]) named.truth += (named.truth.empty() ? "" : "+") + std::string(terms[k]);
  if (named.truth.empty()) named.truth = "geometry";
  return named;
}

}  // namespace

RigidRobot rigid_robot(int seed) {
  const Chain truth = with_random_errors(er20(), {}, Rng(seed));
  RigidRobot robot{{er20(), {}, tracker, readings_of(measured(truth, paper2_poses(40, noise_free), seed))},
                   measured(truth, paper2_poses(200, noise_free), seed + 1000)};
  measure_points(robot.task.data, truth, tracker, Rng(seed + 50));
  return robot;
}

std::vector<NamedTask> named_tasks(const std::string& wanted, int simulated) {
  std::vector<NamedTask> tasks;
  const auto add = [&](const std::string& name, const std::function<CalibrationTask()>& make) {
    if (name.find(wanted) != std::string::npos) tasks.push_back({name, make()});
  };
  if (const char* data = std::getenv("KINFER_DATA")) {
    const std::string folder = data;
    for (const auto& [name, file] : {std::pair{"ur10_a", "Series_A_measurements_grid.csv"},
                                     std::pair{"ur10_b", "Series_B_measurements_joint_configurations.csv"},
                                     std::pair{"ur10_c", "Series_C_measurements_random_poses.csv"}})
      add(name, [&, file = file] { return measured_task(ur10_chain(), ur10_series(folder, file, ur10_chain())); });
    add("mukca_1", [&] {
      const Chain chain = mukca_chain(folder);
      return measured_task(chain, mukca_rows(folder, "panda_1", {"back-high", "right", "front"}, chain));
    });
    add("mukca_2", [&] {
      const Chain chain = mukca_chain(folder);
      return measured_task(chain, mukca_rows(folder, "panda_2",
                                             {"back_left", "front_center", "front_right", "mid-high", "mid_right",
                                              "front_left", "back_right", "high", "mid_left"},
                                             chain));
    });
    add("positioner", [&] { return measured_task(positioner_chain(), positioner_rows(folder, positioner_chain())); });
    add("fr3", [&] { return measured_task(fr3_chain(), fr3_rows(folder, fr3_chain())); });
  }
  if (const char* cases = std::getenv("KINFER_CASES"))
    for (const char* name : {"robot6_tracker", "ur_like_metres", "scara_screw", "arm7_outliers"})
      add(std::string("case_") + name, [&] { return case_task(std::string(cases) + "/calibrate/" + name); });
  for (int seed = 1; seed <= simulated; ++seed)
    if (fmt::format("simulated_{:02}", seed).find(wanted) != std::string::npos) tasks.push_back(simulated_task(seed));
  return tasks;
}

}  // namespace kinfer::study
