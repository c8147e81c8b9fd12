// SPDX-License-Identifier: Apache-2.0
// The joints of a segment tree from the root outwards, each by its search or from its pair of sensors.
#pragma once

#include "kinfer/identify/joints/joint_result.hpp"
#include "kinfer/identify/programming/link_engine.hpp"
#include "kinfer/identify/structure/joint_type.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"

namespace kinfer::identify {

struct LinkSearchOptions {
  LinkEngine engine{};
  double smoothing = 0.02;  ///< [s] of the joint signals: that of the motion
  int links = 0;            ///< number of links from the root outwards; 0: all
  int threads = 0;
};

/// Parents before children. `types`: of joint_types. A joint that hardly moves is that of its pair.
Result<std::vector<JointResult>> search_links(const OrderedMotion& ordered, const std::vector<JointTypeEvidence>& types,
                                              const LinkSearchOptions& options, const Rng& rng,
                                              const Observer& observer);

}  // namespace kinfer::identify
