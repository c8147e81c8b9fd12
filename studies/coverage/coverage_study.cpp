// SPDX-License-Identifier: Apache-2.0
// Do the standard deviations of `predict` hold? Share of points that were not fitted within the 95 % ellipsoids of
// prediction and instrument: of random halves, and of halves of the joint space. Measured sets have gross errors among
// the rows that were not fitted, too: in brackets the share without the rows that a calibration of all rows names so.
// `./dev study coverage simulated [FIRST_SEED]`, `./dev study coverage real|ur10|mukca|positioner|fr3|case_`
#include <fmt/format.h>

#include <set>

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
#include "studies/support/data_sets.hpp"
#include "support/robots.hpp"

namespace kinfer::study::coverage_study {
using namespace calibrate;
namespace {

struct Coverage {
  int inside = 0, all = 0, sound_inside = 0, sound = 0;  ///< sound: without gross errors
  double error = 0.0, sd = 0.0;                          ///< [m²] sums over all points
  Coverage& operator+=(const Coverage& more) {
    inside += more.inside, all += more.all, sound_inside += more.sound_inside, sound += more.sound;
    error += more.error, sd += more.sd;
    return *this;
  }
};

/// A robot, and its rows with gross errors.
struct MeasuredRobot {
  CalibrationTask task;
  std::set<int> gross_errors{};
};

/// Fitted on the train rows, judged on the others.
Coverage coverage(const MeasuredRobot& robot, const Split& split) {
  CalibrationTask task = robot.task;
  task.data = select(robot.task.data, split.train);
  const PoseSet rest = select(robot.task.data, split.holdout);
  const auto fitted = calibrate_robot(task, {.threads = 2}, Rng(1));
  if (!fitted || !fitted->prediction) return {};
  const Chain chain = corrected_chain(*fitted);
  const auto poses = deploy::predict_poses(chain, rest, fitted->prediction);
  const auto uncertainties = deploy::predict_uncertainties(chain, *fitted->prediction, rest);
  if (!poses || !uncertainties) return {};
  const Weights weights =
      weights_of(rest, task.instrument.value_or(Instrument{.sigma = fitted->prediction->noise, .sigma_angle = 0.0}));
  const double limit = chi_squared_quantile(0.95, 3.0);
  Coverage found;
  for (std::size_t k = 0; k < rest.points.size(); ++k) {
    const PointMeasurement& point = rest.points[k];
    if (point.target >= 0) continue;
    const Vec3 error = point.position - (*poses)[point.row].position;
    const Mat3 noise = covariance_of(weights.of<PointMeasurement>()[k], point.axes);
    const Mat3 covariance = (*uncertainties)[point.row].position + noise;
    const auto solved = solve_spd(MatrixXd(covariance), VectorXd(error));
    const bool is_inside = solved && error.dot(Vec3(*solved)) <= limit;
    const bool is_sound = !robot.gross_errors.contains(split.holdout[static_cast<std::size_t>(point.row)]);
    found.inside += is_inside, found.sound_inside += is_inside && is_sound, found.sound += is_sound;
    ++found.all, found.error += error.squaredNorm(), found.sd += covariance.trace();
  }
  return found;
}

std::string figures(const Coverage& c) {
  if (c.all == 0) return "-";
  const auto n = static_cast<double>(c.all);
  const std::string sound =
      c.sound == c.all ? "" : fmt::format(" [{:.1f} % of {}]", 100.0 * c.sound_inside / c.sound, c.sound);
  return fmt::format("{:5.1f} % of {:5}{} (rms {:.4f}, expected {:.4f} mm)", 100.0 * c.inside / n, c.all, sound,
                     1e3 * std::sqrt(c.error / n), 1e3 * std::sqrt(c.sd / n));
}

struct Both {
  Coverage halves, regions;
};

Both judge(const MeasuredRobot& robot, int seeds, int regions = 4) {
  Both both;
  for (int seed = 1; seed <= seeds; ++seed)
    both.halves += coverage(robot, random_split(static_cast<int>(robot.task.data.rows()), 0.5, Rng(seed)));
  for (const Split& split : extrapolation_splits(robot.task.data))
    if (regions-- > 0) both.regions += coverage(robot, split);
  return both;
}

void print(const std::string& name, const Both& both) {
  fmt::print("{:34} {:66} {}\n", name, figures(both.halves), figures(both.regions));
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
  return {{nominal, {}, test::tracker, test::measured(truth, {.poses = rows, .instrument = test::tracker}, seed)}};
}

void simulated_robots(int first_seed) {
  Both all;
  for (int seed = first_seed; seed < first_seed + 30; ++seed) {
    const MeasuredRobot robot = simulated(seed);
    const Both one = judge(robot, 1);
    print(fmt::format("simulated {}, {} rows", seed, robot.task.data.rows()), one);
    all.halves += one.halves, all.regions += one.regions;
  }
  print("30 simulated robots", all);
}

/// Rows that a calibration of all rows names as gross errors.
std::set<int> gross_errors_of(const CalibrationTask& task) {
  const auto fitted = calibrate_robot(task, {.threads = 2}, Rng(1));
  if (!fitted) return {};
  return {fitted->gross_error_rows.begin(), fitted->gross_error_rows.end()};
}

void real_robots(const std::string& wanted) {
  for (const NamedTask& named : named_tasks(wanted, 0))
    print(named.name, judge({named.task, gross_errors_of(named.task)}, named.name.starts_with("ur10") ? 2 : 5));
}

}  // namespace
}  // namespace kinfer::study::coverage_study

int kinfer::study::run_coverage(int argc, char** argv) {
  std::string what = "simulated";
  int first_seed = 1;
  ArgumentParser app("Share of unseen points within the 95 % ellipsoids of predictions");
  app.add_option("robots", what, "simulated, real, or a part of a real set's name");
  app.add_option("first_seed", first_seed, "Of the simulated robots");
  if (const auto code = app.exit_code(argc, argv)) return *code;
  fmt::print("{:34} {:66} {}\n", "robot", "random halves", "halves of the joint space");
  if (what == "simulated") coverage_study::simulated_robots(first_seed);
  if (what != "simulated") coverage_study::real_robots(what == "real" ? "" : what);
  return 0;
}
