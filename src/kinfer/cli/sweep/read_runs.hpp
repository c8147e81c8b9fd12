// SPDX-License-Identifier: Apache-2.0
// The rows of a fleet from the folders of its sweeps.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/fleet/fleet.hpp"

namespace kinfer::cli {

/// One row for each key of the manifests, and for each folder that no manifest names. A record that is truncated or
/// foreign makes its row unreadable, and nothing else. Errors: a folder without a manifest; a key in two folders.
Result<std::vector<FleetRow>> read_runs(const std::vector<std::string>& folders);

/// Fills in what the data of these rows say about their robots; a row whose file is damaged becomes unreadable.
void read_information(std::vector<FleetRow>& rows, const std::vector<int>& which);

}  // namespace kinfer::cli
