// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/model/layout.hpp"

#include <algorithm>

namespace kinfer::track {

FilterLayout layout_of(const InsBodies& bodies, Index sensors, Index unseen_angles, Index unseen_points) {
  FilterLayout layout{.sensors = sensors};
  Index geometry = 0;
  for (const InsBody& body : bodies) {
    const auto parent = static_cast<std::size_t>(std::max(0, body.parent));
    const bool is_root = layout.position.empty();
    const Index dof = degrees_of_freedom(body.motion);
    layout.position.push_back(dof > 0 ? layout.positions : -1);
    layout.geometry.push_back(geometry);
    layout.positions += dof;
    geometry += is_root ? 0 : body.unknowns();
    // Bodies are in topological order, so everything that a body depends on lies before its own.
    layout.fast_end.push_back(dof > 0   ? layout.joint_state(layout.positions)
                              : is_root ? base_states
                                        : layout.fast_end[parent]);
    layout.geometry_end.push_back(geometry);
  }
  layout.fast = layout.joint_state(layout.positions);
  layout.first_unseen = layout.sensor_state(sensors);
  layout.first_point = layout.first_unseen + unseen_angles;
  layout.first_geometry = layout.first_point + unseen_points;
  layout.size = layout.first_geometry + geometry;
  return layout;
}

}  // namespace kinfer::track
