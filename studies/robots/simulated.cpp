// SPDX-License-Identifier: Apache-2.0
#include "simulated.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/plan/plan_poses.hpp"
#include "studies/support/chains.hpp"
#include "studies/support/table.hpp"
#include "support/instruments.hpp"

namespace kinfer::study::robots_study {
using namespace calibrate;
using namespace plan;
namespace {

using namespace test;

constexpr int seeds = 5;

Chain with_tool(Chain chain) {
  chain.tool.xyz = Vec3(0.03, 0.02, 0.1);
  return chain;
}

PoseSimulation free_space(int poses, Instrument instrument) {
  return {.poses = poses, .instrument = instrument};
}

double held_out_error(const Chain& found, const Chain& truth, const PoseSimulation& like) {
  PoseSimulation exact = like;
  exact.poses = 300, exact.instrument = {};
  return 1e3 * mean(point_errors(found, measured(truth, exact, 4321)));
}

Calibration calibrated(const Chain& nominal, const Instrument& instrument, const PoseSet& data) {
  return calibrate_robot({nominal, {}, instrument, data}, {}, Rng(1)).value();
}

/// Mean over seeds of the error on held-out poses [mm] beside the target; the base is unknown.
void tracked(const std::string& name, double target, const Chain& nominal, const PoseSimulation& simulation) {
  std::vector<double> errors, expected;
  std::string models;
  for (int seed = 1; seed <= seeds; ++seed) {
    Chain truth = with_random_errors(nominal, {}, Rng(100 + seed));
    truth.base = Frame::from_pose(Pose::from_xyz_rpy({1.2, -2.5, 0.35}, {0.02, -0.03, 2.3}));
    const PoseSet data = measured(truth, simulation, seed);
    const Calibration c = calibrated(nominal, simulation.instrument, data);
    errors.push_back(held_out_error(c.estimate.chain, truth, simulation));
    expected.push_back(1e3 * c.estimate.predicted_error);
    if (selected_model(c.model_selection) != "geometry") models += "; " + selected_model(c.model_selection);
  }
  print_row(name, target, mean(errors), fmt::format("rms by the covariance {:.4f}{}", mean(expected), models));
}

/// The same number of poses, planned instead of random.
void planned(const std::string& name, double target, const Chain& nominal, const PoseSimulation& simulation) {
  PlanTask task;
  task.nominal = nominal;
  task.instrument = simulation.instrument;
  const PosePlan plan = plan_poses(task, {.poses = simulation.poses}, Rng(1)).value();
  std::vector<double> errors;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Chain truth = with_random_errors(nominal, {}, Rng(100 + seed));
    PoseSet data;
    data.joint_names = active_joint_names(nominal);
    data.joints = plan.joints;
    measure_points(data, truth, simulation.instrument, Rng(200 + seed));
    errors.push_back(
        held_out_error(calibrated(nominal, simulation.instrument, data).estimate.chain, truth, simulation));
  }
  print_row(name, target, mean(errors),
            fmt::format("expected rms {:.4f}; lower bound for any choice {:.4f}", 1e3 * plan.expected.rms,
                        1e3 * plan.rms_lower_bound));
}

void outliers() {
  const Chain truth = with_random_errors(with_tool(er20(0.125)), {}, Rng(7));
  PoseSet data = measured(truth, paper2_poses(70, tracker));
  std::vector<int> wrong, listed;
  Rng rng(3);
  for (int row = 3; wrong.size() < 12; row += 5 + row % 2) {
    const double size = rng.uniform(1e-3, 0.3);
    data.points[row].position += size * noise(rng, 1.0).normalized();
    wrong.push_back(row);
  }
  const Calibration c = calibrated(with_tool(er20(0.125)), tracker, data);
  for (const Outlier& outlier : c.estimate.outliers) listed.push_back(outlier.row);
  print_row("12 gross outliers of 70 rows", 0.025, held_out_error(c.estimate.chain, truth, paper2_poses(1, tracker)),
            listed == wrong ? "exactly those rows listed" : fmt::format("{} rows listed", listed.size()));
}

void draw_wire() {
  std::vector<double> errors;
  for (int seed = 1; seed <= seeds; ++seed) {
    Chain nominal = with_tool(er20(0.125));
    nominal.fixtures.anchors = {Vec3(1.8, -0.9, 0.1), Vec3(1.7, 1.1, 0.2), Vec3(0.2, 0.3, 2.4)};
    Chain truth = with_random_errors(nominal, {}, Rng(20 + seed));
    truth.base = nominal.base;
    Rng rng(40 + seed);
    for (Vec3& anchor : truth.fixtures.anchors) anchor += noise(rng, 5e-3);
    PoseSet data = readings_of(measured(truth, paper2_poses(50, noise_free), seed));
    measure_distances(data, truth, 10e-6, Rng(60 + seed));
    const Calibration c = calibrated(nominal, {.sigma = 10e-6}, data);
    PoseSet test_poses = readings_of(measured(truth, paper2_poses(300, noise_free), 4321));
    measure_distances(test_poses, truth, 0.0, Rng(1));
    errors.push_back(1e3 * mean(residual_norms(kind_of<DistanceMeasurement>, c.estimate.chain, test_poses)));
  }
  print_row("draw-wire, three anchors known to 5 mm (distance)", 0.035, mean(errors));
}

void payload() {
  std::vector<double> errors, refused;
  std::string model;
  for (int seed = 1; seed <= seeds; ++seed) {
    Chain nominal = with_tool(er20(0.125));
    nominal.masses = {{1, Vec3(0.4, 0, 0.1), 60.0}, {2, Vec3(0.1, 0, 0.1), 40.0}, {4, Vec3(0, 0, 0.05), 10.0}};
    Chain truth = with_random_errors(nominal, {}, Rng(50 + seed));
    const double compliance[] = {0.5e-6, 2e-6, 3e-6, 4e-6, 5e-6, 5e-6};
    for (int j = 0; j < 6; ++j) truth.joints[j].compliance = compliance[j];
    PoseSet data = readings_of(measured(truth, paper2_poses(50, noise_free), seed));
    for (int row = 0; row < data.rows(); ++row) data.payload.push_back(row % 2 ? 20.0 : 0.0);
    measure_points(data, truth, tracker, Rng(70 + seed));
    const Calibration c = calibrated(nominal, tracker, data);
    model = selected_model(c.model_selection);
    PoseSet unseen = readings_of(measured(truth, paper2_poses(300, noise_free), 4321));
    for (int row = 0; row < unseen.rows(); ++row)
      unseen.payload.push_back(row % 3 == 0 ? 20.0 : row % 3 == 1 ? 10.0 : 0.0);
    measure_points(unseen, truth, noise_free, Rng(1));
    errors.push_back(1e3 * mean(point_errors(c.estimate.chain, unseen)));
  }
  print_row("compliance with a payload column", 0.020, mean(errors), model);
}

/// A tracker at the world's origin, accurate to 10 µm in range and 30 µrad in direction, with covariances and without.
void tracker_of_poor_angles() {
  const Chain nominal = with_tool(er20(0.125));
  std::vector<double> without_covariance, with_covariance;
  for (int seed = 1; seed <= seeds; ++seed) {
    Chain truth = with_random_errors(nominal, {}, Rng(300 + seed));
    truth.base = Frame::from_pose(Pose::from_xyz_rpy({2.4, -2.2, 0.35}, {0.02, -0.03, 2.3}));
    PoseSet data = measured(truth, paper2_poses(50, noise_free), seed);
    Rng rng(400 + seed);
    for (PointMeasurement& point : data.points) {
      const Vec3 along = point.position.normalized();
      const double range = 10e-6, across = 30e-6 * point.position.norm();
      const auto [sd, axes] = principal_deviations(across * across * Mat3::Identity() +
                                                   (range * range - across * across) * along * along.transpose());
      point.position += axes * sd.cwiseProduct(noise(rng, 1.0));
      point.sd = sd, point.axes = axes;
    }
    const auto error_of_fit = [&](const PoseSet& rows) {
      const Calibration c = calibrate_robot({nominal, {}, std::nullopt, rows}, {}, Rng(1)).value();
      return held_out_error(c.estimate.chain, truth, paper2_poses(1, tracker));
    };
    with_covariance.push_back(error_of_fit(data));
    for (PointMeasurement& point : data.points) point.sd.reset(), point.axes.reset();
    without_covariance.push_back(error_of_fit(data));
  }
  print_row("range to 10 um, direction to 30 urad, with covariances", mean(without_covariance), mean(with_covariance),
            "target: without them");
}

void half_of_the_joints() {
  Chain nominal = with_tool(er20(0.125));
  Chain truth = with_random_errors(nominal, {}, Rng(5));
  Chain held = truth;
  for (const int j : {2, 4, 5}) held.joints[j].lower = held.joints[j].upper = 0.3;
  const PoseSet data = measured(held, paper2_poses(50, tracker));
  const Calibration c = calibrated(nominal, tracker, data);
  Chain as_nominal = nominal;
  as_nominal.base = c.estimate.chain.base;
  const PoseSimulation like = paper2_poses(1, tracker);
  Chain frames_refitted = nominal;
  frames_refitted.base = truth.base;
  print_row("three of six joints move, on poses where all do", held_out_error(frames_refitted, truth, like),
            held_out_error(c.estimate.chain, truth, like),
            fmt::format("{} groups of undetermined parameters", c.estimate.identifiability.undetermined.size()));
}

}  // namespace

void simulated_robots() {
  print_head("Simulated, mean error on held-out poses [mm], mean of 5 seeds");
  tracked("six axes, unknown tracker frame", 0.025, with_tool(er20(0.125)), paper2_poses(50, tracker));
  tracked("UR10-like, three parallel axes", 0.024, ur10_like(), free_space(50, tracker));
  tracked("SCARA with gain", 0.021, scara(), free_space(50, tracker));
  tracked("seven axes, 0.05 mm noise", 0.030, seven_axes(), free_space(50, Instrument{.sigma = 50e-6}));
  tracked("seven axes, error vectors of 0.05 mm", 0.030, seven_axes(),
          free_space(50, Instrument{.sigma = 50e-6 / std::sqrt(3.0)}));
  planned("seven axes, 0.05 mm noise, 50 planned poses", 0.030, seven_axes(),
          free_space(50, Instrument{.sigma = 50e-6}));
  tracked("the same with 80 poses, as in the reference case", 0.030, seven_axes(),
          free_space(80, Instrument{.sigma = 50e-6}));
  tracker_of_poor_angles();
  outliers();
  draw_wire();
  payload();
  half_of_the_joints();
}

}  // namespace kinfer::study::robots_study
