// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/handover/complete_tracking.hpp"

#include <algorithm>

#include "kinfer/inertial/filters/kinfer_filter.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;
using Kind = TrackingParameterKind;

/// [rad/s] rms by which a filter's bias is off beyond what it states: accelerations that last look like gravity. The
/// biases of fit and filter differ by that on DIODEM trial 1, rigid, second half.
constexpr double filter_bias_sd = 2e-3;

struct FilteredBias {
  Vec3 bias = Vec3::Zero();
  Mat3 covariance = Mat3::Zero();
};

/// At the end of the recording.
FilteredBias filtered_bias(const InsRecording& recording, const InsSensor& sensor, double prior_sd) {
  KinferFilterOptions options;
  options.magnetometer = MagnetometerUse::off;
  options.rate_sample = RateSample::at_its_time;
  options.bias_sd = prior_sd;
  KinferFilter filter(options);
  const auto time = recording.time(sensor);
  for (std::size_t row = 0; row < sensor.rows(); ++row) filter.add(sample(sensor, time, row));
  FilteredBias found{filter.estimate().bias, filter.covariance().block<3, 3>(5, 5)};
  found.covariance.diagonal().array() += filter_bias_sd * filter_bias_sd;
  return found;
}

/// The number of a parameter that describes a sensor; none for those of the geometry.
double* value_of(TrackingModel& model, const TrackingParameter& parameter) {
  if (parameter.kind < Kind::gyroscope_bias) return nullptr;
  TrackingSensor& sensor = model.sensors[static_cast<std::size_t>(parameter.index)];
  const Index at = parameter.component;
  switch (parameter.kind) {
    case Kind::gyroscope_bias:
      return &sensor.gyroscope_bias[at];
    case Kind::accelerometer_bias:
      return &sensor.accelerometer_bias[at];
    case Kind::gyroscope_scale:
      return &sensor.gyroscope_scale(at % 3, at / 3);
    default:
      return &sensor.accelerometer_scale(at % 3, at / 3);
  }
}

}  // namespace

TrackingModel with_filtered_biases(TrackingModel model, const InsRecording& recording, const InsCommonScales& common) {
  const double factor = common.gyroscope.factor;  // by which the recording was divided and the model was not
  if (!model.base.moved || model.prior.bias.rate <= 0.0) return model;
  const Index rows = 3 * static_cast<Index>(model.sensors.size()), size = static_cast<Index>(model.parameters.size());
  VectorXd innovation(rows);
  MatrixXd noise = MatrixXd::Zero(rows, rows), selection = MatrixXd::Zero(size, rows);
  for (std::size_t s = 0; s < model.sensors.size(); ++s) {
    const auto sensor = std::ranges::find(recording.sensors, model.sensors[s].name, &InsSensor::name);
    if (sensor == recording.sensors.end()) return model;
    const FilteredBias found = filtered_bias(recording, *sensor, model.prior.bias.rate / factor);
    const Index row = 3 * static_cast<Index>(s);
    innovation.segment<3>(row) = factor * found.bias - model.sensors[s].gyroscope_bias;
    noise.block<3, 3>(row, row) = factor * factor * found.covariance;
  }
  for (Index i = 0; i < size; ++i) {
    const TrackingParameter& parameter = model.parameters[static_cast<std::size_t>(i)];
    if (parameter.kind == Kind::gyroscope_bias) selection(i, 3 * parameter.index + parameter.component) = 1.0;
  }
  const MatrixXd cross = product(model.covariance, selection);
  const MatrixXd spread = product(selection.transpose(), cross) + noise;
  MatrixXd gain = solve_semidefinite(spread, cross.transpose()).transpose();
  for (Index i = 0; i < size; ++i)
    if (model.parameters[static_cast<std::size_t>(i)].kind < Kind::gyroscope_bias) gain.row(i).setZero();
  const VectorXd change = product(gain, innovation);
  for (Index i = 0; i < size; ++i)
    if (double* value = value_of(model, model.parameters[static_cast<std::size_t>(i)])) *value += change[i];
  const MatrixXd known = product(gain, cross.transpose());
  model.covariance += product(product(gain, spread), gain.transpose()) - known - known.transpose();
  return model;
}

TrackingModel complete(TrackingModel model, const Identification& found, const InsRecording& recording,
                       const InsCommonScales& common) {
  model = with_limited_deviations(with_filtered_biases(std::move(model), recording, common));
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
