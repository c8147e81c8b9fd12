// SPDX-License-Identifier: Apache-2.0
// The list of verbs. A new verb needs its own file, a line here and a line in verbs.cpp.
#pragma once

#include "kinfer/cli/parts/common.hpp"

namespace kinfer::cli {

Verb add_identify(CLI::App& app);
Verb add_calibrate(CLI::App& app);
Verb add_predict(CLI::App& app);
Verb add_plan(CLI::App& app);
Verb add_forecast(CLI::App& app);
Verb add_track(CLI::App& app);
Verb add_verify(CLI::App& app);
Verb add_inspect(CLI::App& app);
Verb add_convert(CLI::App& app);
Verb add_simulate(CLI::App& app);
Verb add_simulate_poses(CLI::App& app);
Verb add_orient(CLI::App& app);
Verb add_compensate(CLI::App& app);
Verb add_reach(CLI::App& app);
Verb add_path(CLI::App& app);
Verb add_pair(CLI::App& app);
Verb add_frames(CLI::App& app);
Verb add_report(CLI::App& app);
Verb add_sweep(CLI::App& app);
Verb add_merge(CLI::App& app);
Verb add_demo(CLI::App& app);
Verb add_completion(CLI::App& app);
Verb add_man(CLI::App& app);

/// Adds every verb to the program, in the order of its help text.
std::vector<Verb> add_verbs(CLI::App& app);

}  // namespace kinfer::cli
