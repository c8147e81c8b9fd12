// SPDX-License-Identifier: Apache-2.0
// kinfer frames: base and tool frames from single-joint sweeps (paper 2, section 2.2).
#include <memory>

#include "kinfer/calibrate/start/circle_point_analysis.hpp"
#include "kinfer/cli/options/robot_option.hpp"
#include "kinfer/cli/parts/run_record.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/evidence/frames_json.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/words/calibration/frames.hpp"

namespace kinfer::cli {
namespace {

struct FramesArguments {
  CommonOptions common;
  RobotOption robot;
  std::string data, out, columns;
};

std::string summary(const FrameEstimate& found) {
  const Vec3 tool = 1e3 * found.chain.tool.xyz;
  std::string text = fmt::format(
      "Base from the sweeps of {}. Tool on the flange: {:.4f} {:.4f} {:.4f} mm (by the paper's {}: {:.4f} mm).\n\n",
      words::base_source(found), tool.x(), tool.y(), tool.z(), words::tool_length_source(found),
      1e3 * found.tool_length);
  text += fmt::format("  {:<18} {:<8} {:>5} {:>9} {:>11} {:>9} {:>11} {:>10} {:>10} {:>11}\n", "sweep", "joint", "rows",
                      "swept", "radius", "rms", "centre sd", "axis sd", "off by", "turned by");
  text += fmt::format("  {:<18} {:<8} {:>5} {:>9} {:>11} {:>9} {:>11} {:>10} {:>10} {:>11}\n", "", "", "", "deg", "mm",
                      "mm", "mm", "deg", "mm", "deg");
  for (const SweepCircle& c : found.sweeps)
    text += fmt::format("  {:<18} {:<8} {:>5} {:>9.1f} {:>11.4f} {:>9.4f} {:>11.4f} {:>10.5f} {:>10.4f} {:>11.5f}\n",
                        words::sweep_name(c), c.joint, c.rows, c.swept / degree, 1e3 * c.radius, 1e3 * c.rms,
                        1e3 * c.centre_sd, c.axis_sd / degree, 1e3 * c.off_by, c.axis_angle / degree);
  return text + fmt::format(
                    "\noff by, turned by: the chain's axis in these frames against the circle's.\n"
                    "The start that calibrate finds from all rows differs by {:.4f} mm and {:.5f} deg (base) and "
                    "{:.4f} mm (tool).\n",
                    1e3 * found.base_differs, found.base_turned / degree, 1e3 * found.tool_differs);
}

Result<void> write_results(OutputFolder& folder, RobotModel robot, const FrameEstimate& found) {
  robot.chain = found.chain;
  if (auto done = write_text_file(folder / "chain.toml", format_robot_toml(robot)); !done) return done;
  return write_text_file(folder / "evidence.json", format_frames_evidence(frames_evidence(found)));
}

int run(const FramesArguments& options) {
  RunRecord record("frames", options.common);
  for (const std::string& path : {options.robot.path, options.data}) record.add_input(path);
  auto robot = read_robot(options.robot);
  if (!robot) return fail(robot.error());
  const auto map = read_columns_option(options.columns);
  if (!map) return fail(map.error());
  const auto data = read_pose_set(options.data, robot->chain, *map);
  if (!data) return fail(data.error());
  const auto found = calibrate::estimate_frames_from_circles(robot->chain, *data);
  if (!found) return fail({options.data + ": " + found.error().what});
  auto folder = record.open_folder(options.out);
  if (!folder) return fail(folder.error());
  if (auto done = write_results(*folder, *robot, *found); !done) return fail(done.error());
  if (auto done = record.write(*folder); !done) return fail(done.error());
  if (auto done = folder->commit(); !done) return fail(done.error());
  if (options.common.json)
    print_data(format_frames_evidence(frames_evidence(*found)));
  else if (!options.common.quiet)
    print_text("{}", summary(*found));
  return exit_done;
}

}  // namespace

Verb add_frames(CLI::App& app) {
  CLI::App* verb = add_command(
      app, "frames", "Base and tool from sweeps of single joints, by circle fits",
      "Sweeps are marked in a column called sweep, or found: rows in which one joint alone moves.\nExample:\n"
      "  kinfer frames --robot robot.toml --data sweeps.csv --out frames");
  auto options = std::make_shared<FramesArguments>();
  add_robot_option(*verb, options->robot, "--robot", "Nominal model: " + readable_model_formats());
  add_text(*verb, "--data", options->data, "Pose set with sweeps of single joints", Requirement::required, "CSV");
  add_text(*verb, "--out", options->out, "Folder for chain.toml (base and tool found), evidence.json, run.json",
           Requirement::required, "DIR");
  add_text(*verb, "--columns", options->columns, "How a foreign file's columns map to kinfer's", Requirement::optional,
           "TOML");
  add_common_options(*verb, options->common);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
