// SPDX-License-Identifier: Apache-2.0
// Whether each joint may be used, from the evidence for and against it.
#pragma once

#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/identify/screening/connection.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"

namespace kinfer::identify {

/// One for each joint of the result, in its order; `result`: with joints, forecast and notes. `connections`: of the
/// links of the tree.
std::vector<JointVerdict> joint_verdicts(const Identification& result, const OrderedMotion& ordered,
                                         const std::vector<PairConnection>& connections);

/// Makes the geometry of joints unknown whose segments are not connected: a point of two unrelated bodies is none.
void withdraw_unconnected(Identification& result);

}  // namespace kinfer::identify
