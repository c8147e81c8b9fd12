// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/smooth/reversed.hpp"

namespace kinfer::track {

TrackingModel reversed(TrackingModel model) {
  for (TrackingSensor& sensor : model.sensors) {
    sensor.gyroscope_bias = -sensor.gyroscope_bias;
    sensor.clock_offset = -sensor.clock_offset;
  }
  for (std::size_t i = 0; i < model.parameters.size(); ++i) {
    if (model.parameters[i].kind != TrackingParameterKind::gyroscope_bias) continue;
    const auto at = static_cast<Eigen::Index>(i);
    model.covariance.row(at) *= -1.0;
    model.covariance.col(at) *= -1.0;
  }
  return model;
}

InsRow reversed(InsRow row, double end) {
  row.time = end - row.time;
  for (InsSample& sample : row.sensors) {
    sample.time = end - sample.time;
    sample.angular_velocity = -sample.angular_velocity;
  }
  return row;
}

}  // namespace kinfer::track
