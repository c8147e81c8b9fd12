// SPDX-License-Identifier: Apache-2.0
// kinfer inspect: contents of a file and findings about it, without any fit.
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "kinfer/calibrate/diagnosis/diagnose.hpp"
#include "kinfer/cli/inspect/inspect_pose_log.hpp"
#include "kinfer/cli/inspect/inspect_recording.hpp"
#include "kinfer/cli/inspect/inspect_robot_log.hpp"
#include "kinfer/cli/options/orientation_hypotheses.hpp"
#include "kinfer/cli/options/robot_option.hpp"
#include "kinfer/cli/parts/ins_logs.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/estimate/poses/joint_excitation.hpp"
#include "kinfer/io/evidence/findings_json.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/recording/recording_formats.hpp"
#include "kinfer/io/text/dump_json.hpp"
#include "kinfer/words/findings/findings.hpp"

namespace kinfer::cli {
namespace {

struct InspectArguments {
  RobotOption robot;
  std::string columns;
  std::vector<std::string> files, topics;
  bool allan = false, json = false;
};

std::string joint_table(const std::vector<JointExcitation>& joints) {
  std::string text = fmt::format("  {:<16} {:>10} {:>10} {:>10}\n", "joint", "from", "to", "sd");
  for (const JointExcitation& j : joints) {
    const double factor = j.is_revolute ? 1.0 / degree : 1e3;
    text += fmt::format("  {:<16} {:>10.2f} {:>10.2f} {:>10.2f} {}\n", j.name, factor * j.lower, factor * j.upper,
                        factor * j.sd, j.is_revolute ? "deg" : "mm");
  }
  return text;
}

std::string measured_line(const PoseSet& set) {
  std::string text;
  for_each_list(set, [&]<class M>(const std::vector<M>& list) {
    if (!list.empty()) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", list.size(), M::traits.plural);
  });
  return text;
}

std::string finding_lines(const std::vector<Finding>& findings) {
  if (findings.empty()) return "  nothing wrong was found\n";
  std::string text;
  for (const Finding& f : findings) {
    text += fmt::format("  {}: {}{}\n", name(f.severity), words::sentence(f),
                        f.lines.size() == 1 ? fmt::format(" (line {})", f.lines.front()) : "");
    if (f.applied) text += "    certain: calibrate corrects it by itself, and says so\n";
    if (const std::string remedy = words::suggestion(f); !remedy.empty()) text += fmt::format("    -> {}\n", remedy);
  }
  return text;
}

int inspect_pose_set(const std::string& file, const RobotModel& robot, const ColumnMap& map, bool json) {
  const auto set = read_pose_set(file, robot.chain, map);
  if (!set) return fail(set.error());
  const calibrate::CalibrationTask task{
      .nominal = robot.chain, .tolerances = robot.tolerances, .instrument = robot.instrument, .data = *set};
  const calibrate::Diagnosis diagnosis =
      calibrate::diagnose(task, [&] { return orientation_hypotheses(file, robot.chain, map); });
  if (json) {
    print_data(format_findings(diagnosis.findings) + "\n");
    return exit_done;
  }
  print_text("{}: {} poses of {} joints; measured: {}\n", file, set->rows(), set->joints.rows(), measured_line(*set));
  print_text("{}", joint_table(measure_joint_excitation(robot.chain, *set)));
  print_text("{}", finding_lines(diagnosis.findings));
  return exit_done;
}

/// The topics of each robot log; whether one of them has an INS.
Result<bool> inspect_topics(const InspectArguments& options) {
  bool has_ins = false;
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const std::string& file : options.files) {
    if (!is_robot_log(file)) continue;
    KINFER_TRY(log, read_topics(file));
    has_ins |= has_imu(log);
    if (options.json)
      all.push_back({{"file", file}, {"kind", "robot_log"}, {"topics", topics_json(log)}});
    else
      print_topics(file, log);
  }
  // With an INS the recording's own object follows, which is the answer then.
  if (options.json && !has_ins) print_data(dump_json(all, 1) + "\n");
  return has_ins;
}

int run(const InspectArguments& options) {
  if (std::ranges::any_of(options.files, is_robot_log)) {
    const auto has_ins = inspect_topics(options);
    if (!has_ins) return fail(has_ins.error());
    if (!*has_ins && std::ranges::all_of(options.files, is_robot_log)) return exit_done;
  }
  const bool is_mapped_log = options.robot.path.empty() && !options.columns.empty();
  if (is_mapped_log || is_recording(options.files.front()))
    return inspect_recording({options.files, options.columns, options.topics},
                             options.allan ? AllanPlot::print : AllanPlot::none,
                             options.json ? InspectOutput::json : InspectOutput::text);
  if (std::ranges::all_of(options.files, is_pose_log)) {
    for (const std::string& file : options.files)
      if (const int code = inspect_pose_log(file, options.json); code != exit_done) return code;
    return exit_done;
  }
  if (options.robot.path.empty())
    return fail({fmt::format("{}: no INS recording (no columns t and SENSOR_ax ...); a pose set needs --robot",
                             options.files.front())});
  const auto robot = read_robot(options.robot);
  if (!robot) return fail(robot.error());
  const auto map = read_columns_option(options.columns);
  if (!map) return fail(map.error());
  for (const std::string& file : options.files)
    if (const int code = inspect_pose_set(file, *robot, *map, options.json); code != exit_done) return code;
  return exit_done;
}

}  // namespace

Verb add_inspect(CLI::App& app) {
  CLI::App* verb =
      add_command(app, "inspect", "What was understood of a file, and what is wrong with it, before any fit",
                  "Example:\n  kinfer inspect poses.csv --robot robot.toml\n  kinfer inspect imu.csv --allan");
  auto options = std::make_shared<InspectArguments>();
  add_robot_option(*verb, options->robot, "--robot", "Robot of a pose set: " + readable_model_formats(),
                   Requirement::optional);
  add_texts(*verb, "files", options->files,
            "INS recordings, one a logger (files, folders or zip archives of phones); robot logs (.mcap, .bag, .db3, "
            "folders); "
            "joint logs and tracker files; or pose sets with --robot",
            Requirement::required, "CSV");
  add_log_options(*verb, options->columns, options->topics);
  add_flag(*verb, "--allan", options->allan,
           "Allan deviation of each sensor's longest rest: noise and bias instability");
  add_flag(*verb, "--json", options->json, "Print what was understood and found as JSON");
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
