// SPDX-License-Identifier: Apache-2.0
// Sentences on what a recording does not determine of a joint, and on the measurement that would.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/identification/joint_estimate.hpp"

namespace kinfer::words {

/// "where the axis is in ins0, which does not rotate". `joint`: the one that it belongs to.
std::string unobservable_text(const Unobservable& unobservable, const JointEstimate& joint);

/// "record once more on a slope, or with a magnetometer"; for a free choice, what may be chosen.
std::string remedy_text(const Unobservable& unobservable);

/// Both, separated by a colon; one for each unobservable quantity of the joint.
std::vector<std::string> unobservable_sentences(const JointEstimate& joint);

}  // namespace kinfer::words
