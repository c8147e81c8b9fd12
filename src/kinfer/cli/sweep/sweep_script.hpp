// SPDX-License-Identifier: Apache-2.0
// Job files that run the shards of a sweep on an engine that exists.
#pragma once

#include <string>
#include <vector>

namespace kinfer::cli {

/// "parallel", "slurm", "mpi", "dask", "kubernetes"
std::vector<std::string> engine_names();

/// The text of the script; `command`: the sweep to run, without its shard, quoted for a shell; `shards`: how many.
std::string sweep_script(const std::string& engine, const std::string& command, int shards);

}  // namespace kinfer::cli
