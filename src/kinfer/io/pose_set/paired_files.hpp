// SPDX-License-Identifier: Apache-2.0
// A pose set out of two files, a robot's joint log and a tracker's: read, their rests found and matched.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/io/pose_set/pose_log.hpp"
#include "kinfer/measurement/pairing/paired_set.hpp"

namespace kinfer {

struct PairedSources {
  std::filesystem::path joints, measured;
  PoseLogChoice joint_choice{}, measured_choice{};
};

struct PairingOptions {
  std::optional<PairingMethod> method{};  ///< none: by what the files have
  std::optional<double> offset{};         ///< [s] tracker's clock minus robot's, roughly
  bool has_model = true;                  ///< the chain is a nominal model whose tool points decide between pairings
};

struct PairedFiles {
  PoseLog joints{}, measured{};
  RestLists lists{};
  RestPairing pairing{};
  PoseSet set{};  ///< one row a pair
};

Result<PairedFiles> read_paired_files(const PairedSources& sources, const Chain& chain, const PairingOptions& options);

/// "line 12", "pose3, lines 4 to 9, 1.20 s to 3.00 s": where a rest stands in its file.
std::string place_of_rest(const PoseSet& set, const Rest& rest);

}  // namespace kinfer
