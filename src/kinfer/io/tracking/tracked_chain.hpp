// SPDX-License-Identifier: Apache-2.0
// An identified machine as `kinfer track` takes it: the chain, what tracking needs besides, and the tool.
#pragma once

#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

struct TrackedChain {
  Chain chain;
  TrackingModel model;
};

/// `folder`: of kinfer identify. The tool is that of chain.toml or, with `facts` (a file, or empty), the place in it
/// that is named "tip" or "tool" or is the only one, with known coordinates.
Result<TrackedChain> read_tracked_chain(const std::string& folder, const std::string& facts);

}  // namespace kinfer
