// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/handover/told_biases.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/inertial/rest/rest.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

// [rad/s] The fit takes its chain for granted, and biases drift within the recording. Set on 24 recordings of 28 s by
// consumer sensors: with 2e-3 the type of one joint in 120 is wrong, with this none.
constexpr double least_bias_sd = 5e-4;
constexpr double agreeing_deviations = 2.0;

/// [rad/s] of the axis that the fit knows worst.
double bias_sd(const TrackingModel& model, std::size_t sensor) {
  double variance = 0.0;
  for (std::size_t i = 0; i < model.parameters.size(); ++i) {
    const TrackingParameter& parameter = model.parameters[i];
    if (parameter.kind == TrackingParameterKind::gyroscope_bias && parameter.index == static_cast<int>(sensor))
      variance = std::max(variance, model.covariance(static_cast<Index>(i), static_cast<Index>(i)));
  }
  return std::sqrt(variance);
}

}  // namespace

std::vector<GyroscopeBias> told_biases(const TrackingModel& model, const InsRecording& recording,
                                       const InsCommonScales& common) {
  std::vector<GyroscopeBias> told;
  for (std::size_t s = 0; s < model.sensors.size(); ++s) {
    const auto sensor = std::ranges::find(recording.sensors, model.sensors[s].name, &InsSensor::name);
    if (sensor == recording.sensors.end() || !rest_periods(*sensor, recording.time(*sensor)).empty()) continue;
    const double factor = common.gyroscope.factor;
    told.push_back(
        {sensor->name, model.sensors[s].gyroscope_bias / factor, std::max(least_bias_sd, bias_sd(model, s) / factor)});
  }
  return told;
}

bool agrees_with_one_of(const std::vector<GyroscopeBias>& before, const GyroscopeBias& bias) {
  const auto own = std::ranges::find(before, bias.sensor, &GyroscopeBias::sensor);
  return own != before.end() &&
         (bias.mean - own->mean).cwiseAbs().maxCoeff() < agreeing_deviations * std::hypot(bias.sd, own->sd);
}

}  // namespace kinfer::identify
