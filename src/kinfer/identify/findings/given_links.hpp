// SPDX-License-Identifier: Apache-2.0
// Whether the evidence against a given tree stands: pairs of sensors may agree better than neighbours do where axes
// coincide or hardly anything accelerates, so a given link is wrong only if the whole chain of the estimated tree
// predicts held-out motion better.
#pragma once

#include "kinfer/evidence/identification/identification.hpp"

namespace kinfer::identify {

/// Whether a given link is called a fault.
bool contradicts_given_links(const Identification& given);

/// Turns the faults of given links into notes where the chain of the given tree predicts as well as the other one.
void weigh_given_links(Identification& given, const Identification& estimated);

}  // namespace kinfer::identify
