// SPDX-License-Identifier: Apache-2.0
// A path sampled in time as CSV (docs/formats.md, `path`).
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/motion/timed_path.hpp"

namespace kinfer {

/// t[s], then q, qd and qdd of every joint: angles in deg, lengths of joints that are not `rotational` in mm.
std::string format_path_csv(const TimedPath& path, const std::vector<bool>& rotational);

}  // namespace kinfer
