// SPDX-License-Identifier: Apache-2.0
// Do the standard deviations of `predict` hold? Share of points that were not fitted within the 95 % ellipsoids of
// prediction and instrument: of random halves, and of halves of the joint space.
// `./dev study coverage simulated [FIRST_SEED]`, `./dev study coverage real|UR10|positioner|FR3`
#include <fmt/format.h>

#include <cstdlib>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/calibrate/validation/extrapolation_splits.hpp"
#include "kinfer/deploy/predict.hpp"
#include "kinfer/estimate/poses/pose_weights.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/measurement/split.hpp"
#include "studies/studies.hpp"
#include "studies/support/arguments.hpp"
#include "studies/support/chains.hpp"
#include "studies/support/files.hpp"
#include "support/robots.hpp"

namespace kinfer::study::coverage_study {
using namespace calibrate;
namespace {

struct Coverage {
  int inside = 0, all = 0;
  double error = 0.0, sd = 0.0;  ///< [m²] sums over the points
  Coverage& operator+=(const Coverage& more) {
    inside += more.inside, all += more.all, error += more.error, sd += more.sd;
    return *this;
  }
};

struct MeasuredRobot {
  Chain nominal;
  std::optional<Instrument> instrument;
  PoseSet data;
};

/// Fitted on the train rows, judged on the others.
Coverage coverage(const MeasuredRobot& robot, const Split& split) {
  const PoseSet train = select(robot.data, split.train), rest = select(robot.data, split.holdout);
  const auto fitted = calibrate_robot({robot.nominal, {}, robot.instrument, train}, {.threads = 2}, Rng(1));
  if (!fitted || !fitted->prediction) return {};
  const Chain chain = corrected_chain(*fitted);
  const auto poses = deploy::predict_poses(chain, rest, fitted->prediction);
  const auto uncertainties = deploy::predict_uncertainties(chain, *fitted->prediction, rest);
  if (!poses || !uncertainties) return {};
  const Weights weights =
      weights_of(rest, robot.instrument.value_or(Instrument{.sigma = fitted->prediction->noise, .sigma_angle = 0.0}));
  const double limit = chi_squared_quantile(0.95, 3.0);
  Coverage found;
  for (std::size_t k = 0; k < rest.points.size(); ++k) {
    const PointMeasurement& point = rest.points[k];
    if (point.target >= 0) continue;
    const Vec3 error = point.position - (*poses)[point.row].position;
    const Mat3 noise = covariance_of(weights.of<PointMeasurement>()[k], point.axes);
    const Mat3 covariance = (*uncertainties)[point.row].position + noise;
    const auto solved = solve_spd(MatrixXd(covariance), VectorXd(error));
    if (solved && error.dot(Vec3(*solved)) <= limit) ++found.inside;
    ++found.all, found.error += error.squaredNorm(), found.sd += covariance.trace();
  }
  return found;
}

std::string figures(const Coverage& c) {
  if (c.all == 0) return "-";
  const auto n = static_cast<double>(c.all);
  return fmt::format("{:5.1f} % of {:5} (rms {:.4f}, expected {:.4f} mm)", 100.0 * c.inside / n, c.all,
                     1e3 * std::sqrt(c.error / n), 1e3 * std::sqrt(c.sd / n));
}

struct Both {
  Coverage halves, regions;
};

Both judge(const MeasuredRobot& robot, int seeds, int regions = 4) {
  Both both;
  for (int seed = 1; seed <= seeds; ++seed)
    both.halves += coverage(robot, random_split(static_cast<int>(robot.data.rows()), 0.5, Rng(seed)));
  for (const Split& split : extrapolation_splits(robot.data))
    if (regions-- > 0) both.regions += coverage(robot, split);
  return both;
}

void print(const std::string& name, const Both& both) {
  fmt::print("{:34} {:52} {}\n", name, figures(both.halves), figures(both.regions));
  std::fflush(stdout);
}

/// With terms that kinfer knows, and with one that it does not: an error of the gear's third harmonic.
MeasuredRobot simulated(int seed) {
  Chain nominal = seed % 3 == 0 ? ur10_like() : seed % 3 == 1 ? test::nominal_robot() : scara();
  Chain truth = with_random_errors(nominal, {}, Rng(seed));
  Rng rng(100 + seed);
  const double gear = seed % 2 ? 0.0 : 1e-4, unknown = seed % 5 == 0 ? 1e-4 : 0.0;
  for (Joint& joint : truth.joints) {
    const double sine = rng.normal(), cosine = rng.normal(), third = rng.normal();
    if (rotates(joint.type)) joint.harmonics = {{1.0, gear * sine, gear * cosine}, {3.0, unknown * third, 0.0}};
  }
  const int rows = 40 + static_cast<int>(rng.index(260));
  return {nominal, test::tracker, test::measured(truth, {.poses = rows, .instrument = test::tracker}, seed)};
}

void simulated_robots(int first_seed) {
  Both all;
  for (int seed = first_seed; seed < first_seed + 30; ++seed) {
    const MeasuredRobot robot = simulated(seed);
    const Both one = judge(robot, 1);
    print(fmt::format("simulated {}, {} rows", seed, robot.data.rows()), one);
    all.halves += one.halves, all.regions += one.regions;
  }
  print("30 simulated robots", all);
}

void real_robots(const std::string& folder, const std::string& only) {
  const auto study = [&](const std::string& name, int seeds, const Chain& chain, const auto& rows) {
    if (only == "real" || name.find(only) != std::string::npos)
      print(name, judge({chain, std::nullopt, rows(folder, chain)}, seeds));
  };
  for (const char* file : {"Series_A_measurements_grid.csv", "Series_B_measurements_joint_configurations.csv",
                           "Series_C_measurements_random_poses.csv"})
    study(fmt::format("UR10 {:.8}", file), 2, ur10_chain(),
          [&](const std::string& from, const Chain& chain) { return ur10_series(from, file, chain); });
  study("positioner", 5, positioner_chain(), positioner_rows);
  study("FR3", 5, fr3_chain(), fr3_rows);
}

}  // namespace
}  // namespace kinfer::study::coverage_study

int kinfer::study::run_coverage(int argc, char** argv) {
  std::string what = "simulated";
  int first_seed = 1;
  ArgumentParser app("Share of unseen points within the 95 % ellipsoids of predictions");
  app.add_option("robots", what, "simulated, real, or a part of a measured set's name");
  app.add_option("first_seed", first_seed, "Of the simulated robots");
  if (const auto code = app.exit_code(argc, argv)) return *code;
  const char* data = std::getenv("KINFER_DATA");
  fmt::print("{:34} {:52} {}\n", "robot", "random halves", "halves of the joint space");
  if (what == "simulated") coverage_study::simulated_robots(first_seed);
  if (what != "simulated" && data) coverage_study::real_robots(data, what);
  return 0;
}
