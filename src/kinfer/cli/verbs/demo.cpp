// SPDX-License-Identifier: Apache-2.0
// kinfer demo: an excavator identified and a robot calibrated, from simulated measurements, in a new folder.
#include <filesystem>
#include <memory>

#include "kinfer/cli/demo_robot.hpp"
#include "kinfer/cli/parts/program.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/files/text_file.hpp"

namespace kinfer::cli {
namespace {

struct DemoArguments {
  std::string out = "kinfer-demo";
  bool quiet = false;
  int threads = 0;
};

/// Runs one verb as a user would, and shows the command.
int step(const DemoArguments& options, const char* what, std::vector<std::string> arguments) {
  std::string command = "kinfer";
  for (const std::string& argument : arguments) command += " " + argument;
  if (!options.quiet) print_message("\n== {}\n$ {}\n", what, command);
  arguments.insert(arguments.end(), {"--threads", std::to_string(options.threads)});
  if (options.quiet) arguments.emplace_back("--quiet");
  return Program().run(arguments);
}

Result<void> write_robot_files(const std::filesystem::path& folder) {
  if (auto done = create_writable_folder(folder / "robot"); !done) return done;
  if (auto done = write_text_file(folder / "robot/robot.toml", demo_robot_toml); !done) return done;
  return write_text_file(folder / "robot/errors.toml", demo_errors_toml);
}

int run(const DemoArguments& options) {
  const std::filesystem::path folder = options.out;
  std::error_code ignored;
  if (std::filesystem::exists(folder, ignored) && !std::filesystem::is_empty(folder, ignored))
    return fail({fmt::format("{}: expected a new or an empty folder", options.out)});
  if (auto done = write_robot_files(folder); !done) return fail(done.error());
  const auto in = [&](const char* name) { return (folder / name).string(); };
  const std::pair<const char*, std::vector<std::string>> steps[] = {
      {"a simulated excavator drives, with sensors in arbitrary mountings",
       {"simulate", "excavator-general", "--out", in("drive")}},
      {"its chain is identified from their recording alone",
       {"identify", in("drive/imu.csv"), "--out", in("excavator")}},
      {"a simulated tracker measures a robot that differs from its data sheet",
       {"simulate-poses", "--robot", in("robot/robot.toml"), "--errors", in("robot/errors.toml"), "--out", in("data")}},
      {"the robot is calibrated",
       {"calibrate", "--robot", in("data/robot.toml"), "--data", in("data/poses.csv"), "--out", in("calibration")}},
  };
  for (const auto& [what, arguments] : steps)
    if (const int code = step(options, what, arguments); code != exit_done) return code;
  if (!options.quiet) print_text("\nOpen {} and {}.\n", in("excavator/report.html"), in("calibration/report.html"));
  return exit_done;
}

}  // namespace

Verb add_demo(CLI::App& app) {
  CLI::App* verb =
      add_command(app, "demo", "Identify a simulated machine and calibrate a simulated robot, to see it work",
                  "Example:\n  kinfer demo\n  xdg-open kinfer-demo/excavator/report.html");
  auto options = std::make_shared<DemoArguments>();
  add_text(*verb, "--out", options->out, "New folder for all files", Requirement::optional, "DIR");
  add_count(*verb, "--threads", options->threads, 0, 1024, "Number of threads; 0: all cores");
  add_quiet_option(*verb, options->quiet);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
