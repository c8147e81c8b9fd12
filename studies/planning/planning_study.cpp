// SPDX-License-Identifier: Apache-2.0
// Gain of pose planning: 15 planned poses against 15 random ones, by the error on held-out poses.
//
//   ./dev study planning OUT [FOLDER_OF_UR10_SERIES]
//
// Simulated: five robots, tracker of 10 µm + 5 µm/m, errors drawn from the tolerances; rigid, compliant, with gears.
// Measured: series B and C of the public UR10 set (data/ur10/robot.toml names the source), choosing among their poses.
#include <fmt/format.h>

#include <filesystem>

#include "kinfer/io/files/text_file.hpp"
#include "studies/studies.hpp"
#include "trials.hpp"

int kinfer::study::run_planning(int argc, char** argv) {
  using namespace kinfer;
  const std::filesystem::path out = argc > 1 ? argv[1] : "out/planning";
  std::string table = "set,fit,choice,mean_mm,worst_mm,mean_ratio,worst_ratio\n";
  table += planning_study::simulated_robots();
  if (argc > 2) {
    const auto measured = planning_study::measured_robot(argv[2]);
    if (!measured) return fmt::print(stderr, "{}\n", measured.error().what), 2;
    table += *measured;
  }
  std::filesystem::create_directories(out);
  return write_text_file(out / "planning.csv", table) ? 0 : 2;
}
