// --method and the settings of a search by a population (paper 2), as `calibrate` has them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/cli/common.hpp"

namespace kinfer::cli {

struct SearchArguments {
  std::string method = "lm", warm_start, walls = "absorb", net_use = "initial-swarm";
  std::vector<std::string> prior;
  int particles = 200, iterations = 20000;
  double inertia = 0.8, own = 0.5, swarm = 1.25;
  double box_length = 1.0, box_angle = 1.0, box_tolerances = 0.0;  // mm, deg
};
void add_search_arguments(CLI::App& verb, SearchArguments& arguments);

/// How the population searches, with the net of the earlier calibration where there is one; none for lm.
Result<std::optional<PopulationOptions>> population_options(const SearchArguments& arguments, int threads);

/// Fills `earlier` and `fleet` from --warm-start and --prior. Each must have the joints of the nominal robot.
Result<void> read_earlier_calibrations(const SearchArguments& arguments, CalibrateTask& task);

/// The files that were read.
std::vector<std::string> input_paths(const SearchArguments& arguments);

}  // namespace kinfer::cli
