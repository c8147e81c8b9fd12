// SPDX-License-Identifier: Apache-2.0
// What a tracking model takes from the steps after the fit: clocks and the tool.
#pragma once

#include "kinfer/evidence/identification/identification.hpp"

namespace kinfer::identify {

/// `found`: with its chain, places and clocks.
TrackingModel complete(TrackingModel model, const Identification& found);

}  // namespace kinfer::identify
