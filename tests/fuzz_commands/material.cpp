// SPDX-License-Identifier: Apache-2.0
#include "fuzz_commands/material.hpp"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

namespace kinfer::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr const char* grade_toml = R"(name = "mine"
units = { acceleration = "mg", angular_rate = "deg/s" }
[accelerometer]
noise_density = 0.1
bias = 2.0
range = 16000
[gyroscope]
noise_density = 0.005
bias = 0.1
)";
constexpr const char* facts_toml = R"(units = { length = "mm" }
[[place]]
name = "tip"
sensor = "ins3"
xyz = [100, 0, 50]
sigma = 1
)";
constexpr const char* names_toml = "parameters = [\"a1\", \"d1\", \"theta1\"]\n";
constexpr const char* columns_toml = "[columns]\nq1 = \"q1[deg]\"\nx = \"x[mm]\"\n";
constexpr const char* targets_csv = "x[mm],y[mm],z[mm]\n900,100,700\n800,-200,900\n";
constexpr const char* scara_toml = R"(name = "scara"
convention = "dh"
units = { length = "mm", angle = "deg" }
[instrument]
sigma = 0.02
[[joint]]
type = "revolute"
limits = [-170, 170]
a = 400
alpha = 0
d = 300
theta = 0
[[joint]]
name = "elbow"
type = "revolute"
limits = [-140, 140]
a = 300
alpha = 180
d = 0
theta = 0
compliance = 1e-6
[[joint]]
type = "prismatic"
limits = [0, 200]
a = 0
alpha = 0
d = 0
theta = 0
[[mass]]
link = 2
mass = 10
com = [-150, 0, 0]
)";

void write(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// The header and some rows.
std::string first_lines(const std::string& text, int lines) {
  std::size_t at = 0;
  for (int i = 0; i < lines && at != std::string::npos; ++i) at = text.find('\n', at + 1);
  return text.substr(0, at == std::string::npos ? at : at + 1);
}

/// Readings of one joint after another, as `frames` wants them.
std::string sweeps_csv() {
  std::string text = "q1[deg],q2[deg],q3[deg],q4[deg],q5[deg],q6[deg],sweep\n";
  for (int joint : {0, 1, 5})
    for (int k = -4; k <= 4; ++k) {
      for (int j = 0; j < 6; ++j) text += fmt::format("{},", j == joint ? 8 * k : 5 + 3 * j);
      text += fmt::format("s{}\n", joint);
    }
  return text;
}

}  // namespace

std::string make_material(const fs::path& program, const fs::path& folder, const Limits& limits) {
  fs::create_directories(folder);
  const std::string robot = std::string(KINFER_SOURCE_DIR) + "/examples/robot6/";
  for (const char* name : {"robot.toml", "errors.toml"}) write(folder / name, read_bytes(robot + name));
  write(folder / "scara.toml", scara_toml), write(folder / "grade.toml", grade_toml);
  write(folder / "facts.toml", facts_toml), write(folder / "names.toml", names_toml);
  write(folder / "columns.toml", columns_toml), write(folder / "targets.csv", targets_csv);
  write(folder / "sweeps.csv", sweeps_csv());
  write(folder / "manifest.csv", "key,verb,arguments\na,convert,robot.toml {out}/a.urdf\nb,inspect,short.csv\n");
  const std::vector<std::string> commands[] = {
      {"man", "--out", "man"},
      {"simulate", "crane", "--rate", "50", "--duration", "15.5", "--out", "drive", "--quiet"},
      {"identify", "drive/imu.csv", "--out", "machine", "--quiet", "--threads", "1"},
      {"simulate-poses", "--robot", "robot.toml", "--errors", "errors.toml", "--poses", "24", "--out", "data"},
      {"simulate-poses", "--robot", "scara.toml", "--measured", "pose", "--poses", "15", "--out", "scara"},
      {"calibrate", "--robot", "data/robot.toml", "--data", "data/poses.csv", "--out", "calibration", "--threads", "1"},
      {"calibrate", "--robot", "scara.toml", "--data", "scara/poses.csv", "--out", "scara_calibration"},
      {"convert", "robot.toml", "robot.urdf"},
      {"convert", "scara.toml", "scara.xml"},
      {"convert", "drive/imu.csv", "imu.mcap"},
      {"predict", "--chain", "data/truth.toml", "--joints", "data/poses.csv", "-o", "predicted.csv"},
      {"predict", "--chain", "data/truth.toml", "--joints", "sweeps.csv", "-o", "swept.csv"}};
  for (const auto& words : commands)
    // Whoever identifies so short a log is told not to use the result.
    if (const auto run = run_process(program, words, folder, limits);
        run.code != 0 && (run.code != 1 || words.front() != "identify"))
      return fmt::format("kinfer {}: exit code {}: {}", fmt::join(words, " "), run.code, run.err);
  write(folder / "short.csv", first_lines(read_bytes(folder / "drive/imu.csv"), 120));
  std::istringstream joints(sweeps_csv()), points(read_bytes(folder / "swept.csv"));
  std::string sheet, left, right;
  while (std::getline(joints, left) && std::getline(points, right)) sheet += left + "," + right + "\n";
  write(folder / "swept.csv", sheet);
  return {};
}

const std::vector<Recipe>& recipes() {
  static const std::vector<Recipe> list{
      {"inspect", {"short.csv"}, 6},
      {"inspect", {"imu.mcap"}, 3},
      {"inspect", {"data/poses.csv", "--robot", "robot.toml"}, 6},
      {"pair", {"--robot", "robot.toml", "--joints", "sweeps.csv", "--measured", "targets.csv", "--out", "out.csv"}, 4},
      {"orient", {"short.csv", "--out", "out.csv"}, 6},
      {"identify", {"drive/imu.csv", "--out", "out", "--threads", "1"}, 2},
      {"identify", {"short.csv", "--out", "out", "--threads", "1"}, 3},
      {"calibrate", {"--robot", "robot.toml", "--data", "data/poses.csv", "--out", "out", "--threads", "1"}, 6},
      {"calibrate", {"--robot", "scara.toml", "--data", "scara/poses.csv", "--out", "out", "--threads", "1"}, 8},
      {"calibrate", {"--robot", "robot.urdf", "--data", "data/poses.csv", "--out", "out", "--threads", "1"}, 2},
      {"calibrate",
       {"--robot", "scara.toml", "--data", "scara/poses.csv", "--out", "out", "--prior", "scara_calibration/chain.toml",
        "scara.toml"},
       4},
      {"calibrate", {"--robot", "scara.xml", "--data", "scara/poses.csv", "--out", "out", "--threads", "1"}, 4},
      {"predict", {"--chain", "scara.toml", "--joints", "scara/poses.csv"}, 6},
      {"predict", {"--chain", "robot.urdf", "--joints", "data/poses.csv", "-o", "out.csv"}, 4},
      {"verify", {"--chain", "calibration/chain.toml", "--data", "data/poses.csv"}, 6},
      {"verify", {"--chain", "calibration/chain.toml", "--against", "data/truth.toml"}, 4},
      {"compensate",
       {"--chain", "calibration/chain.toml", "--nominal", "robot.toml", "--joints", "data/poses.csv", "-o", "out.csv"},
       4},
      {"reach", {"--chain", "robot.toml", "--targets", "targets.csv", "--starts", "20"}, 6},
      {"path", {"--chain", "robot.toml", "--from", "0,-90,90,0,45,0", "--to", "60,-90,90,0,45,0", "-o", "out.csv"}, 6},
      {"path", {"--chain", "robot.toml", "--targets", "targets.csv"}, 3},
      {"track", {"machine", "short.csv", "--out", "out"}, 6},
      {"track", {"machine", "short.csv"}, 4},
      {"frames", {"--robot", "robot.toml", "--data", "swept.csv", "--out", "out"}, 5},
      {"convert", {"robot.toml", "out.urdf"}, 4},
      {"convert", {"scara.toml", "out.mjcf"}, 4},
      {"convert", {"robot.urdf", "out.toml"}, 6},
      {"convert", {"scara.xml", "out.toml"}, 6},
      {"convert", {"short.csv", "out.mcap"}, 4},
      {"simulate", {"crane", "--rate", "20", "--duration", "16", "--out", "out"}, 4},
      {"simulate-poses", {"--robot", "scara.toml", "--poses", "5", "--out", "out"}, 8},
      {"report", {"calibration"}, 8},
      {"report", {"machine"}, 8},
      {"plan", {"--robot", "scara.toml", "--poses", "4", "--out", "out.csv", "--threads", "1"}, 3},
      {"forecast", {"short.csv", "--threads", "1"}, 3},
      {"sweep", {"manifest.csv", "--out", "out", "--workers", "1"}, 3},
      {"completion", {"bash"}, 1},
      {"man", {"calibrate"}, 1}};
  return list;
}

std::vector<std::string> files_for(const std::string& placeholder) {
  if (placeholder == "TOML" || placeholder == "GRADE" || placeholder == "NAME|TOML")
    return {"grade.toml",
            "facts.toml",
            "columns.toml",
            "names.toml",
            "robot.toml",
            "errors.toml",
            "scara_calibration/chain.toml"};
  if (placeholder == "CSV") return {"data/poses.csv", "short.csv", "targets.csv", "sweeps.csv", "manifest.csv"};
  if (placeholder == "DIR") return {"calibration", "machine", "scara_calibration"};
  if (placeholder == "FILE" || placeholder == "ROBOT") return {"robot.toml", "robot.urdf", "scara.toml", "scara.xml"};
  return {};
}

}  // namespace kinfer::fuzz
