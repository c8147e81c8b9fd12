// SPDX-License-Identifier: Apache-2.0
// --method and the options of the population searches (paper 2) for `calibrate`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/calibrate/problem/options.hpp"
#include "kinfer/cli/parts/common.hpp"

namespace kinfer::cli {

struct SearchArguments {
  std::string method = "lm", warm_start, boundary = "absorb", net_use = "initial-swarm";
  std::vector<std::string> prior;
  int particles = 200, iterations = calibrate::swarm_iterations;
  double inertia = 0.8, own = 0.5, swarm = 1.25;
  double box_length = 1.0, box_angle = 1.0, box_tolerances = 0.0;  // mm, deg
};
void add_search_arguments(CLI::App& verb, SearchArguments& arguments);

/// Options of the swarm search, with the network of the earlier calibration if there is one; nullopt for lm.
Result<std::optional<calibrate::SwarmSearchOptions>> read_swarm_options(const SearchArguments& arguments);

/// An error for an option that was given but has no effect with this method.
Result<void> check_search_arguments(const SearchArguments& arguments, const CLI::App& verb);

/// Fills `earlier` and `robot_population` from --warm-start and --prior. Each must have the same joints as the nominal
/// robot, unless that is to be found from the data.
Result<void> read_earlier_calibrations(const SearchArguments& arguments, calibrate::CalibrationTask& task);

/// An error where there is nothing at `path`, or a merged fleet without a readable prior.
Result<void> check_prior(const std::string& path);

/// The files that are read.
std::vector<std::string> input_paths(const SearchArguments& arguments);

}  // namespace kinfer::cli
