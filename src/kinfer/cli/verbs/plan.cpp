// SPDX-License-Identifier: Apache-2.0
// kinfer plan: selection of measurement poses and their expected accuracy.
#include "kinfer/plan/plan_poses.hpp"

#include <charconv>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "kinfer/cli/options/robot_option.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/text/dump_json.hpp"
#include "kinfer/report/parts/plan_figure.hpp"
#include "kinfer/words/calibration/checks.hpp"

namespace kinfer::cli {
namespace {

struct PlanArguments {
  CommonOptions common;
  RobotOption robot;
  std::string out, data, candidates, columns, criterion = "tool", measured = "position", instrument_position;
  int poses = 20;
  struct Given {
    double value = 0.0;
    bool given = false;
  };
  Given lowest;                  // [mm]
  double clearance = 0.0;        // [mm]
  double spacing = 5.0;          // [deg]
  double acceptance_angle = 60;  // [deg]
};

/// "1800,-900,100" [mm] -> [m].
Result<Vec3> parse_point(const std::string& text) {
  Vec3 place = Vec3::Zero();
  const char *at = text.data(), *end = text.data() + text.size();
  for (int i = 0; i < 3; ++i) {
    const auto [next, code] = std::from_chars(at, end, place[i]);
    const bool last = i == 2;
    if (code != std::errc{} || (last ? next != end : next == end || *next != ','))
      return error("--instrument-at {}: expected x,y,z in mm, as 1800,-900,100", text);
    at = next + 1;
  }
  return 1e-3 * place;
}

Result<plan::PlanTask> read_task(const PlanArguments& options, const RobotModel& robot) {
  plan::PlanTask task;
  task.nominal = robot.chain;
  task.tolerances = robot.tolerances;
  if (robot.instrument) task.instrument = plan::planned_instrument(*robot.instrument);
  task.measures = options.measured == "pose" ? plan::Measures::poses : plan::Measures::positions;
  task.space.instrument = robot.instrument_position;
  if (!options.instrument_position.empty()) {
    KINFER_TRY(place, parse_point(options.instrument_position));
    task.space.instrument = place;
  }
  if (options.lowest.given) task.space.lowest = 1e-3 * options.lowest.value;
  task.space.clearance = 1e-3 * options.clearance;
  task.space.acceptance_angle = options.acceptance_angle * degree;
  KINFER_TRY(map, read_columns_option(options.columns));
  if (!options.data.empty()) {
    KINFER_TRY(existing, read_pose_set(options.data, robot.chain, map, RequiredContent::joints_only));
    task.existing = existing;
  }
  if (!options.candidates.empty()) {
    KINFER_TRY(listed, read_pose_set(options.candidates, robot.chain, map, RequiredContent::joints_only));
    task.candidates = listed.joints;
  }
  return task;
}

std::string rows_text(const std::vector<int>& rows) {
  std::string text;
  for (const int row : rows) text += fmt::format("{}{}", text.empty() ? "" : ", ", row);
  return text;
}

std::string expected_line(const char* what, const ExpectedError& e) {
  return fmt::format("  {:<34} {:>6} {:>12.4f} {:>12.4f}\n", what, e.poses, 1e3 * e.rms, 1e3 * e.worst);
}

std::string summary(const PosePlan& plan, const PlanArguments& options) {
  std::string text = fmt::format("{} poses in {}, chosen by {}.\n\n", plan.joints.cols(), options.out,
                                 words::description(plan.criterion));
  if (plan.joints.cols() < options.poses)
    text += fmt::format("Only {} of {} poses are further than {} deg apart.\n\n", plan.joints.cols(), options.poses,
                        options.spacing);
  text += fmt::format("  {:<34} {:>6} {:>12} {:>12}\n", "expected error of the tool [mm]", "poses", "rms", "worst");
  text += expected_line("with these poses", plan.expected);
  if (plan.existing.poses > 0) text += expected_line("with the existing ones alone", plan.existing);
  text += expected_line("with as many random ones", plan.random);
  if (plan.rms_lower_bound > 0.0)
    text += fmt::format("  {:<34} {:>6} {:>12.4f}\n", "no choice of candidates leaves less", plan.expected.poses,
                        1e3 * plan.rms_lower_bound);
  text += fmt::format("  the instrument adds {:.4f} mm per axis to each measurement\n\n", 1e3 * plan.noise);
  const auto& o = plan.observability;
  text += fmt::format(
      "The poses can tell {} combinations of {} parameters. Observability O1 {:.4g}  O2 {:.4g}  O3 {:.4g}  O4 {:.4g}  "
      "O5 "
      "{:.4g}\n(in units of noise and tolerance).\n",
      plan.rank, plan.parameters, o[0], o[1], o[2], o[3], o[4]);
  text += fmt::format("Ordered for least travel: {:.0f} deg, {:.0f} deg as chosen.\n", plan.travel / degree,
                      plan.travel_unordered / degree);
  if (!plan.candidates.empty()) text += "Rows chosen, from 0: " + rows_text(plan.candidates) + "\n";
  if (!plan.redundant_rows.empty())
    text += fmt::format(
        "Existing rows that add hardly any information to the others (leaving all of them out costs less "
        "than 1 % of the criterion): {}\n",
        rows_text(plan.redundant_rows));
  return text;
}

std::string headline_json(const PosePlan& plan) {
  const auto expected = [](const ExpectedError& e) {
    return nlohmann::ordered_json{{"poses", e.poses}, {"rms", e.rms}, {"worst", e.worst}};
  };
  const auto& o = plan.observability;
  const nlohmann::ordered_json json{
      {"criterion", words::description(plan.criterion)},
      {"poses", plan.joints.cols()},
      {"expected", expected(plan.expected)},
      {"existing", expected(plan.existing)},
      {"random", expected(plan.random)},
      {"least_rms", plan.rms_lower_bound},
      {"parameters", plan.parameters},
      {"rank", plan.rank},
      {"observability", {{"O1", o[0]}, {"O2", o[1]}, {"O3", o[2]}, {"O4", o[3]}, {"O5", o[4]}}},
      {"rows", plan.candidates},
      {"leave_out", plan.redundant_rows},
      {"travel_rad", plan.travel}};
  return dump_json(json) + "\n";
}

/// An error for an option that was given but has no effect with --candidates: listed poses are not checked.
Result<void> check_arguments(const PlanArguments& options, const CLI::App& verb) {
  for (const char* constraint : {"--instrument-at", "--acceptance", "--lowest", "--clearance"})
    if (!options.candidates.empty() && was_given(verb, constraint))
      return error("{} has no effect with --candidates: poses are chosen from the list as it is", constraint);
  return {};
}

/// The figure and its numbers stand beside the poses and have their name.
struct PlanFiles {
  std::filesystem::path poses, figure, numbers;
};

Result<PlanFiles> output_files(const PlanArguments& options) {
  const std::filesystem::path poses = options.out;
  std::error_code missing;
  if (std::filesystem::exists(poses, missing) && !std::filesystem::is_regular_file(poses, missing))
    return error("-o {}: expected the name of a file, beside which the figure and its numbers are written",
                 options.out);
  PlanFiles files{poses, poses, poses};
  files.figure.replace_extension(".svg"), files.numbers.replace_extension(".json");
  if (poses == files.figure || poses == files.numbers)
    return error("{}: the figure and its numbers end in .svg and .json; give the poses another extension, as .csv",
                 options.out);
  for (const std::filesystem::path& file : {files.poses, files.figure, files.numbers})
    if (auto other =
            expect_other_file(file.string(), {options.robot.path, options.data, options.candidates, options.columns});
        !other)
      return forward_error(other.error());
  return files;
}

int run(const PlanArguments& options, const CLI::App& verb) {
  if (auto effective = check_arguments(options, verb); !effective) return fail(effective.error());
  const auto files = output_files(options);
  if (!files) return fail(files.error());
  const auto robot = read_robot(options.robot);
  if (!robot) return fail(robot.error());
  const auto task = read_task(options, *robot);
  if (!task) return fail(task.error());
  const plan::PlanOptions how{.poses = options.poses,
                              .criterion = *criterion_named(options.criterion),
                              .spacing = options.spacing * degree,
                              .threads = options.common.threads};
  const auto plan = plan::plan_poses(*task, how, Rng(options.common.seed));
  if (!plan) return fail(plan.error());
  PoseSet poses;
  poses.joint_names = active_joint_names(robot->chain);
  poses.joints = plan->joints;
  if (auto done = write_text_file(files->poses, format_pose_set_csv(poses, robot->chain, FileUnits::mm_deg)); !done)
    return fail(done.error());
  if (auto done = write_text_file(files->figure, report::plan_figure(*plan)); !done) return fail(done.error());
  if (auto done = write_text_file(files->numbers, headline_json(*plan)); !done) return fail(done.error());
  if (options.common.json)
    print_data(headline_json(*plan));
  else if (!options.common.quiet)
    print_text("{}\nFigure: {}\n", summary(*plan, options), files->figure.string());
  return exit_done;
}

}  // namespace

Verb add_plan(CLI::App& app) {
  CLI::App* verb = add_command(
      app, "plan", "Which poses to measure, so that the calibrated tool errs least",
      "Example:\n  kinfer plan --robot robot.toml --poses 20 -o plan.csv --lowest 100 --instrument-at 2500,0,1200");
  auto options = std::make_shared<PlanArguments>();
  add_robot_option(*verb, options->robot, "--robot",
                   "Nominal model, its limits, tolerances and [instrument]: " + readable_model_formats());
  add_count(*verb, "--poses", options->poses, 1, 1000, "Number of poses to choose");
  add_text(*verb, "-o,--out", options->out, "Joint positions of the poses; the figure has the same name with .svg",
           Requirement::required, "CSV");
  add_text(*verb, "--data", options->data, "Poses measured already: which to add, and which are redundant",
           Requirement::optional, "CSV");
  add_text(*verb, "--candidates", options->candidates, "Choose among these poses only (default: any in the space)",
           Requirement::optional, "CSV");
  add_text(*verb, "--columns", options->columns, "How a foreign file's columns map to kinfer's", Requirement::optional,
           "TOML");
  add_choice(*verb, "--criterion", options->criterion, {"tool", "worst", "d", "a", "e"},
             "tool: mean error of the tool over the workspace; worst: its largest; d, a, e: of the parameters");
  add_choice(*verb, "--measured", options->measured, {"position", "pose"}, "What the instrument measures");
  add_text(*verb, "--instrument-at", options->instrument_position,
           "Where the instrument stands in the world [mm]: the tool's z axis must look towards it (default: the robot "
           "file's [instrument] at)",
           Requirement::optional, "X,Y,Z");
  add_number(*verb, "--acceptance", options->acceptance_angle, 1.0, 180.0,
             "Largest angle between the tool's z axis and the instrument [deg]");
  add_number(*verb, "--lowest", options->lowest.value, options->lowest.given, -1e6, 1e6,
             "Tool and joints stay above this height over the base [mm]");
  add_number(*verb, "--clearance", options->clearance, 0.0, 1e6,
             "Tool stays further than this from the base axis [mm]");
  add_number(*verb, "--spacing", options->spacing, 0.0, 90.0,
             "Some joint differs by more than this between any two poses [deg]");
  add_common_options(*verb, options->common);
  return {verb, [options, verb] { return run(*options, *verb); }};
}

}  // namespace kinfer::cli
