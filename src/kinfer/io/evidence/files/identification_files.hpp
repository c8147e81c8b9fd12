// SPDX-License-Identifier: Apache-2.0
// The files that an identification writes beside evidence.json and the report.
#pragma once

#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/io/evidence/files/calibration_files.hpp"

namespace kinfer {

/// chain.toml, chain.urdf, chain.mjcf, chain_dh.csv and track.toml; none where no joint of the chain moves, since no
/// verb could use them.
std::vector<OutputFile> identification_files(const Identification& identification);

}  // namespace kinfer
