// SPDX-License-Identifier: Apache-2.0
#include "studies/thresholds/calibration_figures.hpp"

#include <cmath>
#include <cstdlib>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "studies/support/chains.hpp"
#include "studies/support/files.hpp"
#include "support/instruments.hpp"

namespace kinfer::study::thresholds_study {
using namespace calibrate;
using namespace test;
namespace {

struct RobotErrors {
  double gear = 0.0;              // [rad] amplitude of two harmonics of each joint
  double compliance = 0.0;        // [rad/(N m)] with a payload on every other row
  int gross_errors = 0;           // rows
  double tolerance_factor = 1.0;  // on the geometric errors
};

/// Points of `truth` at the poses of a set, loaded as the payload column says.
PoseSet points_of(const Chain& truth, PoseSet rows, const Instrument& instrument, bool loaded, int seed) {
  if (loaded)
    for (int row = 0; row < rows.rows(); ++row) rows.payload.push_back(row % 2 ? 20.0 : 0.0);
  measure_points(rows, truth, instrument, Rng(seed));
  return rows;
}

MeasuredRobot simulated(Chain nominal, int poses, const RobotErrors& errors, int seed) {
  const bool loaded = errors.compliance > 0.0;
  if (loaded)
    nominal.masses = {{1, Vec3(0.4, 0, 0.1), 60.0}, {2, Vec3(0.1, 0, 0.1), 40.0}, {4, Vec3(0, 0, 0.05), 10.0}};
  Tolerances tolerances;
  tolerances.length *= errors.tolerance_factor, tolerances.angle *= errors.tolerance_factor;
  Chain truth = with_random_errors(nominal, tolerances, Rng(seed));
  Rng rng(seed + 1);
  for (Joint& joint : truth.joints) {
    if (errors.gear > 0.0)
      joint.harmonics = {{1.0, errors.gear * rng.normal(), errors.gear * rng.normal()},
                         {2.0, 0.5 * errors.gear * rng.normal(), 0.5 * errors.gear * rng.normal()}};
    joint.compliance = errors.compliance;
  }
  const auto rows = [&](int count, int of_seed) {
    return readings_of(measured(truth, {.poses = count, .instrument = noise_free}, of_seed));
  };
  MeasuredRobot robot{nominal, tracker, points_of(truth, rows(poses, seed + 2), tracker, loaded, seed + 3), truth,
                      points_of(truth, rows(200, 4321), noise_free, loaded, 1)};
  for (int i = 0; i < errors.gross_errors; ++i) {
    const double size = rng.uniform(1e-3, 0.05);
    robot.data.points[5 * i + 3].position += size * noise(rng, 1.0).normalized();
  }
  return robot;
}

std::vector<MeasuredRobot> ur10_robots(const std::string& folder) {
  const Chain chain = ur10_chain();
  std::vector<MeasuredRobot> robots;
  for (const char* file : {"Series_B_measurements_joint_configurations.csv", "Series_C_measurements_random_poses.csv"})
    robots.push_back({chain, std::nullopt, ur10_series(folder, file, chain)});
  return robots;
}

/// [mm] mean and largest error: on unseen poses of the truth, or on the held-out half.
std::pair<double, double> errors_of(const MeasuredRobot& robot, const Calibration& c) {
  if (!robot.truth) return {1e3 * c.after.position.holdout.mean, 1e3 * c.after.position.holdout.max};
  const std::vector<double> errors = point_errors(c.estimate.chain, robot.unseen);
  return {1e3 * mean(errors), 1e3 * *std::ranges::max_element(errors)};
}

double accepted_terms(const ModelSelection& selection) {
  const std::string model = selected_model(selection);
  return static_cast<double>(std::ranges::count(model, '+'));
}

}  // namespace

std::vector<MeasuredRobot> measured_robots() {
  std::vector<MeasuredRobot> robots;
  for (const int seed : {100, 200}) {
    robots.push_back(simulated(nominal_robot(), 50, {}, seed));
    robots.push_back(simulated(ur10_like(), 80, {.gear = 0.2e-3}, seed + 10));
    robots.push_back(simulated(nominal_robot(), 50, {.compliance = 3e-6}, seed + 20));
    robots.push_back(simulated(nominal_robot(), 70, {.gross_errors = 8}, seed + 30));
    robots.push_back(simulated(seven_axes(), 80, {.tolerance_factor = 20.0}, seed + 40));
    robots.push_back(simulated(scara(), 30, {.gear = 0.5e-3}, seed + 50));
  }
  if (const char* data = std::getenv("KINFER_DATA"))
    for (MeasuredRobot& robot : ur10_robots(data)) robots.push_back(std::move(robot));
  return robots;
}

Figures calibration_figures(const std::vector<MeasuredRobot>& robots) {
  double log_mean = 0.0, log_worst = 0.0, terms = 0.0, excluded = 0.0, usable = 0.0;
  for (const MeasuredRobot& robot : robots) {
    CalibrationOptions options;
    if (!robot.truth) options.holdout = HeldOutFraction{0.5};
    const auto c = calibrate_robot({robot.nominal, {}, robot.instrument, robot.data}, options, Rng(1));
    if (!c) continue;
    const auto [mean_error, worst_error] = errors_of(robot, *c);
    log_mean += std::log(mean_error), log_worst += std::log(worst_error);
    terms += accepted_terms(c->model_selection);
    excluded += static_cast<double>(c->gross_error_rows.size() + c->estimate.outliers.size());
    usable += c->usability == Usability::use;
  }
  const auto count = static_cast<double>(robots.size());
  return {{"mean error, geometric mean over robots [mm]", std::exp(log_mean / count)},
          {"largest error, geometric mean over robots [mm]", std::exp(log_worst / count)},
          {"accepted terms", terms},
          {"excluded rows", excluded},
          {"results to use", usable}};
}

}  // namespace kinfer::study::thresholds_study
