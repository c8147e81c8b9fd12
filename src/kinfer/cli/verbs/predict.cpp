// SPDX-License-Identifier: Apache-2.0
// kinfer predict: forward kinematics of a chain for a file with joint columns.
#include "kinfer/deploy/predict.hpp"

#include <memory>

#include "kinfer/cli/options/robot_option.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/pose_set/pose_log.hpp"
#include "kinfer/io/pose_set/predictions_csv.hpp"
#include "kinfer/words/calibration/prediction.hpp"
#include "kinfer/words/findings/findings.hpp"

namespace kinfer::cli {
namespace {

struct PredictArguments {
  RobotOption chain;
  std::string joints, out, columns;
  bool quiet = false;
};

/// None where the file has no [prediction].
Result<std::vector<PoseDeviations>> deviations_of(const RobotModel& robot, const PoseSet& set) {
  std::vector<PoseDeviations> deviations;
  if (!robot.prediction) return deviations;
  KINFER_TRY(uncertainties, deploy::predict_uncertainties(robot.chain, *robot.prediction, set));
  for (const PoseUncertainty& at : uncertainties)
    deviations.push_back({at.position.diagonal().cwiseSqrt(), at.rotation.diagonal().cwiseSqrt()});
  return deviations;
}

/// What is said on standard error of the predictions.
void print_notices(const RobotModel& robot, const PoseSet& set, const std::string& path) {
  if (!robot.prediction) {
    print_message("kinfer: {}\n", words::no_standard_deviations(path));
  } else if (const auto outside = deploy::find_rows_outside(*robot.prediction, set)) {
    print_message("{}\n", words::sentence(*outside));
  }
}

int run(const PredictArguments& options) {
  if (auto other = expect_other_file(options.out, {options.joints, options.chain.path, options.columns}); !other)
    return fail(other.error());
  const auto robot = read_robot(options.chain);
  if (!robot) return fail(robot.error());
  const auto map = read_columns_option(options.columns);
  if (!map) return fail(map.error());
  const auto log = read_pose_log(options.joints, robot->chain, {.map = *map}, RequiredContent::joints_only);
  if (!log) return fail(log.error());
  if (!options.quiet)
    for (const std::string& remark : log->remarks) print_message("kinfer: {}\n", remark);
  const PoseSet* set = &log->set;
  const auto poses = deploy::predict_poses(robot->chain, *set, robot->prediction);
  if (!poses) return fail(poses.error());
  const auto deviations = deviations_of(*robot, *set);
  if (!deviations) return fail(deviations.error());
  const auto text =
      format_predictions_csv(*poses, *set, robot->chain.base.pose(), robot->chain.fixtures.anchors, *deviations);
  if (!text) return fail(text.error());
  const bool is_for_file = !is_standard_output(options.out);
  if (!is_for_file)
    print_data(*text);
  else if (const auto done = write_text_file(options.out, *text); !done)
    return fail(done.error());
  if (options.quiet) return exit_done;
  print_notices(*robot, *set, options.chain.path);
  if (is_for_file) print_text("{}: {} poses\n", options.out, poses->size());
  return exit_done;
}

}  // namespace

Verb add_predict(CLI::App& app) {
  CLI::App* verb =
      add_command(app, "predict", "Tool poses of a chain for a list of joint positions",
                  "Example:\n  kinfer predict --chain calibration/chain.toml --joints joints.csv -o poses.csv");
  auto options = std::make_shared<PredictArguments>();
  add_chain_option(*verb, options->chain);
  add_text(*verb, "--joints", options->joints, "File with the joint columns q1..; other columns may be there",
           Requirement::required, "CSV");
  add_text(*verb, "-o,--out", options->out,
           "Where to write x,y,z,qw,qx,qy,qz [m] and their standard deviations (default: standard output)",
           Requirement::optional, "CSV");
  add_text(*verb, "--columns", options->columns, "How a foreign file's columns map to kinfer's", Requirement::optional,
           "TOML");
  add_quiet_option(*verb, options->quiet);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
