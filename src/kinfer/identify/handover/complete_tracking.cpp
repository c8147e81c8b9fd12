// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/handover/complete_tracking.hpp"

#include <algorithm>

namespace kinfer::identify {

TrackingModel complete(TrackingModel model, const Identification& found) {
  for (TrackingSensor& sensor : model.sensors) {
    const auto clock = std::ranges::find(found.clocks, sensor.name, &SensorClockEstimate::sensor);
    if (clock == found.clocks.end()) continue;
    sensor.clock_offset = clock->offset;
    sensor.clock_offset_sd = clock->offset_sd;
  }
  const std::string& tip = found.chain.joints[static_cast<std::size_t>(found.chain.tip_joint())].name;
  const auto carrier = std::ranges::find(model.sensors, tip, &TrackingSensor::name);
  if (carrier == model.sensors.end()) return model;
  model.tool = {.body = carrier->body, .body_T_tool = found.chain.tool.pose()};
  for (const PointEstimate& place : found.places)
    if (place.sensor == tip && place.xyz == found.chain.tool.xyz) model.tool.sd = place.sd;
  return model;
}

}  // namespace kinfer::identify
