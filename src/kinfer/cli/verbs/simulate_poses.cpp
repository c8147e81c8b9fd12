// SPDX-License-Identifier: Apache-2.0
// kinfer simulate-poses: a synthetic pose set of a robot with known errors.
#include <memory>
#include <nlohmann/json.hpp>

#include "kinfer/cli/options/robot_option.hpp"
#include "kinfer/cli/parts/run_record.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/robot/toml/robot_errors_toml.hpp"
#include "kinfer/io/text/dump_json.hpp"
#include "kinfer/simulate/pose_set.hpp"

namespace kinfer::cli {
namespace {

struct SimulatePosesArguments {
  CommonOptions common;
  RobotOption robot;
  std::string out, errors, measured = "position";
  int poses = 50;
  struct Given {
    double value = 0.0;
    bool given = false;
  };
  Given sigma, sigma_angle, ppm, lowest;  // [mm], [deg], [um/m], [mm]; default: instrument of the robot file, no floor
  double clearance = 0.0;                 // [mm]
  double shake = 0.0;                     // [deg]
};

PoseSimulation simulation_of(const SimulatePosesArguments& options, const RobotModel& robot) {
  PoseSimulation simulation;
  if (robot.instrument) simulation.instrument = with_lengths(*robot.instrument, simulation.instrument.sigma);
  if (options.sigma.given) simulation.instrument.sigma = 1e-3 * options.sigma.value;
  if (options.sigma_angle.given) simulation.instrument.sigma_angle = options.sigma_angle.value * degree;
  if (options.ppm.given) simulation.instrument.ppm = options.ppm.value;
  simulation.poses = options.poses;
  if (options.lowest.given) simulation.space.lowest = 1e-3 * options.lowest.value;
  simulation.space.clearance = 1e-3 * options.clearance;
  simulation.measured = options.measured == "pose" ? Measured::poses : Measured::positions;
  simulation.shake = options.shake * degree;
  return simulation;
}

Result<Chain> make_true_chain(const SimulatePosesArguments& options, const RobotModel& robot, Rng rng) {
  if (options.errors.empty()) return with_random_errors(robot.chain, robot.tolerances, rng);
  return read_robot_errors(options.errors, robot);
}

std::string headline(const RobotModel& robot, const PoseSet& set, const PoseSimulation& simulation) {
  const Instrument& instrument = simulation.instrument;
  return dump_json(nlohmann::ordered_json{{"robot", robot.chain.name},
                                          {"joints", set.joints.rows()},
                                          {"poses", set.rows()},
                                          {"measured", simulation.measured == Measured::poses ? "pose" : "position"},
                                          {"sigma", instrument.sigma},
                                          {"sigma_angle", instrument.sigma_angle},
                                          {"ppm", instrument.ppm}});
}

int run(const SimulatePosesArguments& options) {
  RunRecord record("simulate-poses", options.common);
  record.add_input(options.robot.path);
  if (!options.errors.empty()) record.add_input(options.errors);
  const auto robot = read_robot(options.robot);
  if (!robot) return fail(robot.error());
  const Rng rng(options.common.seed);
  const auto truth = make_true_chain(options, *robot, rng.stream(1));
  if (!truth) return fail(truth.error());
  const PoseSimulation simulation = simulation_of(options, *robot);
  if (simulation.shake > 0.0 && simulation.measured == Measured::positions)
    return fail(Error{"--shake: needs measured orientations; add --measured pose"});
  const auto set = simulate_pose_set(*truth, simulation, rng.stream(2));
  if (!set) return fail(set.error());

  RobotModel nominal = *robot, true_robot = *robot;
  nominal.instrument = true_robot.instrument = simulation.instrument;
  true_robot.chain = with_small_rotations_folded(*truth);
  auto folder = record.open_folder(options.out);
  if (!folder) return fail(folder.error());
  for (const auto& [name, text] :
       {std::pair{"poses.csv", format_pose_set_csv(*set, robot->chain, FileUnits::mm_deg)},
        std::pair{"robot.toml", format_robot_toml(nominal)}, std::pair{"truth.toml", format_robot_toml(true_robot)}})
    if (auto done = write_text_file(*folder / name, text); !done) return fail(done.error());
  if (auto done = record.write(*folder); !done) return fail(done.error());
  if (auto done = folder->commit(); !done) return fail(done.error());
  if (options.common.json)
    print_data(headline(*robot, *set, simulation) + "\n");
  else if (!options.common.quiet)
    print_text("{} poses of {} in {}: poses.csv (measured), robot.toml (nominal), truth.toml (what made the data)\n",
               set->rows(), robot->chain.name.empty() ? "the robot" : robot->chain.name, options.out);
  return exit_done;
}

}  // namespace

Verb add_simulate_poses(CLI::App& app) {
  CLI::App* verb = add_command(app, "simulate-poses", "Measured poses of a robot with known errors, to try things out",
                               "Example:\n  kinfer simulate-poses --robot robot.toml --poses 50 --out data");
  auto options = std::make_shared<SimulatePosesArguments>();
  add_robot_option(*verb, options->robot, "--robot", "Nominal model: " + readable_model_formats());
  add_text(*verb, "--out", options->out, "Folder for poses.csv, robot.toml, truth.toml", Requirement::required, "DIR");
  add_count(*verb, "--poses", options->poses, 1, 1000000, "Number of poses");
  add_text(*verb, "--errors", options->errors,
           "[errors] name = value by parameter name (default: drawn from the tolerances)", Requirement::optional,
           "TOML");
  add_choice(*verb, "--measured", options->measured, {"position", "pose"}, "What the instrument measures");
  add_number(*verb, "--sigma", options->sigma.value, options->sigma.given, 0.0, 1000.0,
             "Noise of the positions, one sigma per axis [mm] (default: the robot file's, or 0.01)");
  add_number(*verb, "--sigma-angle", options->sigma_angle.value, options->sigma_angle.given, 0.0, 90.0,
             "Noise of the orientations, one sigma per axis [deg]");
  add_number(*verb, "--ppm", options->ppm.value, options->ppm.given, 0.0, 1e5, "Plus this much of the distance [um/m]");
  add_number(*verb, "--lowest", options->lowest.value, options->lowest.given, -1e6, 1e6,
             "Tool stays above this height over the base [mm]");
  add_number(*verb, "--clearance", options->clearance, 0.0, 1e6,
             "Tool stays further than this from the base axis [mm]");
  add_number(
      *verb, "--shake", options->shake, 0.0, 1.0,
      "The instrument's stand turns by this much about each axis between poses [deg]; the file has the covariance "
      "of each pose");
  add_common_options(*verb, options->common);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
