// kinfer inspect: what was understood of a file, and what is wrong with it, before any fit.
#include <memory>

#include "kinfer/calibrate/doctor.hpp"
#include "kinfer/calibrate/excitation.hpp"
#include "kinfer/cli/inspect_recording.hpp"
#include "kinfer/cli/orientation_readings.hpp"
#include "kinfer/cli/robot_option.hpp"
#include "kinfer/cli/verbs.hpp"
#include "kinfer/io/findings_json.hpp"
#include "kinfer/io/pose_set_csv.hpp"

namespace kinfer::cli {
namespace {

struct InspectArguments {
  RobotOption robot;
  std::string columns;
  std::vector<std::string> files;
  bool allan = false, json = false;
};

std::string joint_table(const std::vector<JointExcitation>& joints) {
  std::string text = fmt::format("  {:<16} {:>10} {:>10} {:>10}\n", "joint", "from", "to", "sd");
  for (const JointExcitation& j : joints) {
    const double factor = j.turns ? 1.0 / degree : 1e3;
    text += fmt::format("  {:<16} {:>10.2f} {:>10.2f} {:>10.2f} {}\n", j.name, factor * j.lowest, factor * j.highest,
                        factor * j.sd, j.turns ? "deg" : "mm");
  }
  return text;
}

std::string measured_line(const PoseSet& set) {
  std::string text;
  const auto add = [&](std::size_t n, const char* what) {
    if (n > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", n, what);
  };
  add(set.points.size(), "positions");
  add(set.orientations.size(), "orientations");
  add(set.distances.size(), "distances from anchors");
  add(set.contacts.size(), "socket contacts");
  add(set.pairs.size(), "pairwise distances");
  add(set.plane_contacts.size(), "plane contacts");
  add(set.tilts.size(), "tilts");
  return text;
}

std::string finding_lines(const std::vector<Finding>& findings) {
  if (findings.empty()) return "  nothing wrong was found\n";
  std::string text;
  for (const Finding& f : findings) {
    text += fmt::format("  {}: {}{}\n", name(f.severity), f.sentence,
                        f.lines.size() == 1 ? fmt::format(" (line {})", f.lines.front()) : "");
    if (f.applied) text += "    certain: calibrate puts it right by itself, and says so\n";
    if (!f.suggestion.empty()) text += fmt::format("    -> {}\n", f.suggestion);
  }
  return text;
}

int inspect_pose_set(const std::string& file, const RobotModel& robot, const ColumnMap& map, bool json) {
  const auto set = read_pose_set(file, robot.chain, map);
  if (!set) return fail(set.error());
  const CalibrateTask task{
      .nominal = robot.chain, .tolerances = robot.tolerances, .instrument = robot.instrument, .data = *set};
  const Diagnosis diagnosis = examine(task, [&] { return orientation_readings(file, robot.chain, map); });
  if (json) {
    fmt::print("{}\n", findings_json(diagnosis.findings));
    return exit_done;
  }
  fmt::print("{}: {} poses of {} joints; measured: {}\n", file, set->rows(), set->joints.rows(), measured_line(*set));
  fmt::print("{}", joint_table(joint_excitation(robot.chain, *set)));
  fmt::print("{}", finding_lines(diagnosis.findings));
  return exit_done;
}

int run(const InspectArguments& options) {
  if (is_recording(options.files.front()))
    return inspect_recording(options.files, options.allan ? AllanPlot::print : AllanPlot::none);
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
  add_robot_option(*verb, options->robot, "--robot", "Robot of a pose set: TOML or URDF", Need::optional);
  add_texts(*verb, "files", options->files, "INS recordings, one a logger, or pose sets with --robot", Need::required,
            "CSV");
  add_text(*verb, "--columns", options->columns, "How a foreign file's columns map to kinfer's", Need::optional,
           "TOML");
  add_flag(*verb, "--allan", options->allan,
           "Allan deviation of each sensor's longest rest: noise and bias instability");
  add_flag(*verb, "--json", options->json, "Print the findings about a pose set as one JSON array");
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
