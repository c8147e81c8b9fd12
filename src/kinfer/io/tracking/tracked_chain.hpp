// SPDX-License-Identifier: Apache-2.0
// An identified machine as `kinfer track` takes it: the chain, what tracking needs besides, and the tool.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

struct TrackedChain {
  Chain chain;
  TrackingModel model;
};

/// The files of an identified machine: `chain` is the folder that kinfer identify wrote, or chain.toml or track.toml in
/// it.
struct ChainFiles {
  explicit ChainFiles(const std::string& chain);
  std::vector<std::string> names() const { return {chain.string(), tracking.string()}; }

  std::filesystem::path chain, tracking;
};

/// `chain`: as of ChainFiles. The tool is that of chain.toml or, with `facts` (a file, or empty), the place in it
/// that is named "tip" or "tool" or is the only one, with known coordinates.
Result<TrackedChain> read_tracked_chain(const std::string& chain, const std::string& facts);

}  // namespace kinfer
