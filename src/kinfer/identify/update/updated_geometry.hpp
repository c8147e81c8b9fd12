// SPDX-License-Identifier: Apache-2.0
// The geometry that an update of a chain writes: that of the combined tracking model, at the zeros of the older chain.
#pragma once

#include "kinfer/evidence/identification/chain_update.hpp"
#include "kinfer/identify/refinement/refine_geometry.hpp"

namespace kinfer::identify {

struct UpdatedGeometry {
  ChainGeometry geometry;
  ChainUpdate update;
};

/// `fresh`: of the newer log alone, with a tracking model. `known`: in the order of its joints.
UpdatedGeometry update_geometry(const TrackingModel& known, ChainGeometry fresh);

}  // namespace kinfer::identify
