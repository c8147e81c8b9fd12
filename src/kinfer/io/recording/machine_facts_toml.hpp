// SPDX-License-Identifier: Apache-2.0
// Prior knowledge about a machine besides its recording, from a TOML file (docs/formats.md, "Facts about a machine").
#pragma once

#include <filesystem>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/machine_measurements.hpp"

namespace kinfer {

/// An error names file and line where a fact is incomplete, a window ends before it begins, or a sigma is not positive.
Result<MachineMeasurements> read_machine_facts(const std::filesystem::path& path);
Result<MachineMeasurements> parse_machine_facts(std::string_view text, const std::string& name_in_messages);

}  // namespace kinfer
