// SPDX-License-Identifier: Apache-2.0
// The arguments of a study over seeds: SEEDS MACHINE SETTING..., all settings where none is named.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

namespace kinfer::study {

/// Calls run(machine, setting, seeds) for each setting that is asked for; a setting has a `name`.
template <class Setting, class Run>
void run_settings(int argc, char** argv, int default_seeds, const std::vector<Setting>& settings, Run run) {
  const int seeds = argc > 1 ? std::atoi(argv[1]) : default_seeds;
  const std::string machine = argc > 2 ? argv[2] : "excavator-general";
  for (const Setting& setting : settings) {
    const bool is_named =
        std::any_of(argv + std::min(argc, 3), argv + argc, [&](const char* name) { return setting.name == name; });
    if (argc <= 3 || is_named) run(machine, setting, seeds);
  }
}

}  // namespace kinfer::study
