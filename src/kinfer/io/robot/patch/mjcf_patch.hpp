// SPDX-License-Identifier: Apache-2.0
// An MJCF file with new poses of the bodies whose joints were calibrated, and every other byte as it was.
//
// A body stays where its last joint carries it: geoms, sites, inertias and bodies inside it keep their attributes.
// Where a body has several joints, pos and axis of those before the last one change too.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/io/robot/model/chain_ends.hpp"
#include "kinfer/io/robot/patch/calibrated_origins.hpp"
#include "kinfer/io/robot/patch/xml_edits.hpp"

namespace kinfer {

/// `ends`: with both names (mjcf_ends). Orientations keep their attribute and its unit where it can hold the new one
/// exactly; else a quat takes its place.
Result<PatchedText> patch_mjcf(std::string_view text, const std::string& name_in_messages, const ChainEnds& ends,
                               const std::vector<CalibratedOrigin>& origins);

}  // namespace kinfer
