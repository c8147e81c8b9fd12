// SPDX-License-Identifier: Apache-2.0
// What the search, or the pair of sensors alone, tells about one joint.
#pragma once

#include <optional>

#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/identify/programming/frame_state.hpp"

namespace kinfer::identify {

struct JointResult {
  JointEstimate joint;
  std::vector<DhRowEstimate> dh{};  ///< canonical
  std::vector<IdentificationNote> notes{};
  std::optional<LinkEvidence> search{};                     ///< none: estimated from its two sensors alone
  std::vector<std::size_t> fitted_rows{}, held_out_rows{};  ///< of the search
  std::vector<FrameState> states{};  ///< of the child's sensor at every row, by the chain up to here
};

}  // namespace kinfer::identify
