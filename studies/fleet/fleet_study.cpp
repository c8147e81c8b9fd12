// SPDX-License-Identifier: Apache-2.0
// What the population of a fleet is worth as a prior: robots of a series with 6, 10 and 20 measured poses, their error
// at 500 other poses with and without it; and whether robots that are foreign to the series are noticed.
//
//   ./dev study fleet
//
// A series is 20 robots, measured at 15 to 60 poses. Series "alike": a common error of one tolerance in every joint
// parameter, and own ones of 0.3. Series "as toleranced": own errors of one tolerance, nothing in common: the prior
// cannot help, and must not harm. Everything was chosen on the first seeds; the second ones were run once.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "kinfer/calibrate/fit/population_choice.hpp"
#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/estimate/poses/parameter_information.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/fleet/population_fit.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"
#include "kinfer/simulate/pose_set.hpp"
#include "studies/studies.hpp"

namespace kinfer::study::fleet_study {
using namespace calibrate;
namespace {

constexpr int series_size = 20, new_robots = 10;

struct SeriesKind {
  const char* name;
  double common, own;  ///< [tolerances]
};
constexpr std::array<SeriesKind, 2> kinds{{{"alike", 1.0, 0.3}, {"as toleranced", 0.0, 1.0}}};

/// A robot of the series; base and tool as its set-up has them.
Chain make_robot(const RobotModel& nominal, const SeriesKind& kind, Rng series, Rng robot) {
  Chain chain = with_random_errors(nominal.chain, nominal.tolerances, robot.stream(1));
  Rng shared = series.stream(1), own = robot.stream(2);
  for (const Parameter& p : all_parameters(nominal.chain, nominal.tolerances).parameters) {
    const double common_error = shared.normal(), own_error = own.normal();
    if (!is_joint_parameter(p.at)) continue;
    // Gains and compliances are left as nominal: the fits of this study are of the geometry.
    const bool is_geometry = p.quantity == Quantity::length || p.quantity == Quantity::angle;
    const double errors = kind.common * common_error + kind.own * own_error;
    set_value_at(chain, p.at, is_geometry && std::isfinite(p.prior_sd) ? p.nominal + p.prior_sd * errors : p.nominal);
  }
  return chain;
}

CalibrationTask make_task(const RobotModel& nominal, const Chain& truth, int poses, Rng rng) {
  CalibrationTask task{.nominal = nominal.chain, .tolerances = nominal.tolerances};
  task.instrument = Instrument{.sigma = 50e-6, .sigma_angle = 1e-4};
  task.data = simulate_pose_set(truth, {.poses = poses, .instrument = *task.instrument}, rng).value();
  return task;
}

/// [m] rms error of the tool at poses without noise that were not measured.
double held_out_error(const Chain& found, const Chain& truth, const RobotModel& nominal) {
  const PoseSet at = simulate_pose_set(nominal.chain, {.poses = 500}, Rng(999)).value();
  const auto of_found = evaluate_poses(found, {}, at, Derivative::no).pose;
  const auto of_truth = evaluate_poses(truth, {}, at, Derivative::no).pose;
  std::vector<double> errors;
  for (std::size_t i = 0; i < of_found.size(); ++i)
    errors.push_back((of_found[i].position - of_truth[i].position).norm());
  return rms(errors);
}

PopulationPrior population_of(const RobotModel& nominal, const SeriesKind& kind, Rng series) {
  std::vector<ParameterInformation> robots;
  for (int k = 0; k < series_size; ++k) {
    const Rng rng = series.stream(10).stream(k);
    const int poses = 15 + 45 * k / (series_size - 1);
    const CalibrationTask task = make_task(nominal, make_robot(nominal, kind, series, rng), poses, rng.stream(3));
    const Estimate fit = fit_once(task, task.data, GeometricParameters{}, {}).value();
    robots.push_back(information_of(fit, {task.nominal, task.tolerances}).value());
  }
  std::vector<const ParameterInformation*> list;
  for (const ParameterInformation& robot : robots) list.push_back(&robot);
  return fleet::fit_population(list).value();
}

struct Outcome {
  std::vector<double> without, with;  ///< [m]
  int called_foreign = 0;
};

void calibrate_new_robot(const RobotModel& nominal, const Chain& truth, const PopulationPrior& population, int poses,
                         Rng rng, Outcome& outcome) {
  CalibrationTask task = make_task(nominal, truth, poses, rng);
  const auto error_of = [&](const CalibrationTask& of) {
    return held_out_error(fit_once(of, of.data, GeometricParameters{}, {}).value().chain, truth, nominal);
  };
  outcome.without.push_back(error_of(task));
  task.population = population;
  const PopulationChoice choice = choose_population(task, task.data, GeometricParameters{}, Rng(1)).value();
  outcome.with.push_back(error_of(choice.task));
  outcome.called_foreign += choice.note && choice.note->kind == CalibrationNoteKind::foreign_to_population ? 1 : 0;
}

void report(const RobotModel& nominal, const char* seeds_name, std::uint64_t first_seed, int seeds) {
  for (const SeriesKind& kind : kinds)
    for (const int poses : {6, 10, 20}) {
      Outcome own, foreign;
      for (int s = 0; s < seeds; ++s) {
        const Rng series(first_seed + static_cast<std::uint64_t>(s));
        const PopulationPrior population = population_of(nominal, kind, series);
        for (int k = 0; k < new_robots; ++k) {
          const Rng rng = series.stream(20).stream(k);
          calibrate_new_robot(nominal, make_robot(nominal, kind, series, rng), population, poses, rng.stream(3), own);
          // Of another series: other common errors.
          const Rng other(first_seed + 5000 + static_cast<std::uint64_t>(s));
          calibrate_new_robot(nominal, make_robot(nominal, kinds[1], other, rng), population, poses, rng.stream(3),
                              foreign);
        }
      }
      const auto mm = [](const std::vector<double>& errors) { return 1e3 * median(errors); };
      fmt::print("{:<10} {:<14} {:>5}   {:.3f} -> {:.3f} mm   {:>2} of {}   |   {:.3f} -> {:.3f} mm   {:>2} of {}\n",
                 seeds_name, kind.name, poses, mm(own.without), mm(own.with), own.called_foreign, own.with.size(),
                 mm(foreign.without), mm(foreign.with), foreign.called_foreign, foreign.with.size());
      std::fflush(stdout);
    }
}

}  // namespace

int run() {
  const auto nominal = read_robot_toml(KINFER_SOURCE_DIR "/examples/robot6/robot.toml");
  if (!nominal) return fmt::print(stderr, "{}\n", nominal.error().what), 2;
  fmt::print("{:<10} {:<14} {:>5}   {:<21} {:<10} |   {:<21} {}\n", "seeds", "series", "poses", "robots of the series",
             "foreign", "robots of none", "foreign");
  report(*nominal, "chosen", 1, 2);
  report(*nominal, "reported", 101, 4);
  return 0;
}

}  // namespace kinfer::study::fleet_study

int kinfer::study::run_fleet(int, char**) {
  return fleet_study::run();
}
