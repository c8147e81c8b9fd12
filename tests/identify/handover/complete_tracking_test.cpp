// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/handover/complete_tracking.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/random.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
using namespace identify;
namespace {

using Eigen::Index;
using Kind = TrackingParameterKind;

const Vec3 true_bias(1e-3, -2e-3, 5e-4);  // [rad/s] of both sensors
constexpr double common_error = 0.07;     // [rad/s] of both biases about z, as the fit has them

/// Two sensors that turn about axes which change, gravity being all that they feel.
InsRecording turning_sensors() {
  constexpr double dt = 0.01;
  InsRecording recording;
  recording.loggers.push_back({.name = "log"});
  for (const char* name : {"ins0", "ins1"}) recording.sensors.push_back({.name = name});
  Rng rng(5);
  for (std::size_t s = 0; s < 2; ++s) {
    InsSensor& sensor = recording.sensors[s];
    Mat3 world_R_sensor = rot_x(0.4 + static_cast<double>(s));
    for (int i = 0; i < 6000; ++i) {
      const double t = dt * i;
      const Vec3 rate = 0.5 * Vec3(std::sin(0.9 * t), std::sin(0.7 * t + 1.0), std::sin(1.3 * t + 2.0));
      world_R_sensor = Mat3(world_R_sensor * exp_so3(dt * rate));
      const Vec3 force = world_R_sensor.transpose() * Vec3(0.0, 0.0, 9.81) + 0.02 * normal_vector(rng);
      const Vec3 measured = rate + true_bias + 1e-3 * normal_vector(rng);
      for (std::size_t k = 0; k < 3; ++k) {
        sensor.acceleration.axis[k].push_back(static_cast<float>(force[static_cast<Index>(k)]));
        sensor.angular_velocity.axis[k].push_back(static_cast<float>(measured[static_cast<Index>(k)]));
      }
      sensor.faults.push_back(field_missing);
      if (s == 0) recording.loggers[0].time.push_back(t);
    }
  }
  return recording;
}

/// A hinge between both whose fit knows the difference of the biases to `difference_sd`, and their mean to `mean_sd`.
/// The lever arm shares the mean's error.
TrackingModel hinge(double mean_sd, double difference_sd) {
  TrackingModel model;
  model.sensors = {{.name = "ins0", .body = 0}, {.name = "ins1", .body = 1}};
  for (TrackingSensor& sensor : model.sensors) sensor.gyroscope_bias = true_bias - Vec3(0.0, 0.0, common_error);
  model.bodies.push_back({.sensor = 0});
  model.bodies.push_back({.parent = 0, .sensor = 1, .joint = 0, .motion = TrackingMotion::revolute});
  model.joints.push_back({.name = "ins0-ins1"});
  model.prior.bias.rate = 0.0175;
  model.base.moved = true;
  for (int k = 0; k < 3; ++k) model.parameters.push_back({Kind::point_in_parent, 1, k});
  for (int s = 0; s < 2; ++s)
    for (int k = 0; k < 3; ++k) model.parameters.push_back({Kind::gyroscope_bias, s, k});
  MatrixXd from(9, 6);  // means and differences of the biases to the parameters
  from.setZero();
  const double mean = mean_sd, half = 0.5 * difference_sd;
  for (Index k = 0; k < 3; ++k) {
    from(k, k) = 0.1 * mean;
    from(3 + k, k) = from(6 + k, k) = mean;
    from(3 + k, 3 + k) = half;
    from(6 + k, 3 + k) = -half;
  }
  model.covariance = from * from.transpose();
  return model;
}

double bias_error(const TrackingModel& model) {
  double most = 0.0;
  for (const TrackingSensor& sensor : model.sensors)
    most = std::max(most, (sensor.gyroscope_bias - true_bias).cwiseAbs().maxCoeff());
  return most;
}

TEST(FilteredBiases, ABiasCommonToAllSensorsOfAMovingMachineIsThatWhichGravityShows) {
  const TrackingModel model = hinge(0.017, 1e-4), corrected = with_filtered_biases(model, turning_sensors(), {});
  EXPECT_GT(bias_error(model), 0.069);
  EXPECT_LT(bias_error(corrected), 2e-3);
  EXPECT_LT(std::sqrt(corrected.covariance(5, 5)), 2.5e-3);
}

TEST(FilteredBiases, AreInTheUnitsOfInstrumentsWhoseCommonFactorTheRecordingWasDividedBy) {
  InsCommonScales common;
  common.gyroscope.factor = 2.0;
  TrackingModel model = hinge(0.034, 2e-4);
  for (TrackingSensor& sensor : model.sensors) sensor.gyroscope_bias += true_bias;
  const TrackingModel corrected = with_filtered_biases(model, turning_sensors(), common);
  for (const TrackingSensor& sensor : corrected.sensors)
    EXPECT_LT((sensor.gyroscope_bias - 2.0 * true_bias).cwiseAbs().maxCoeff(), 4e-3);
}

TEST(FilteredBiases, WhatTheFitDeterminedStays) {
  const TrackingModel model = hinge(2e-5, 1e-5), corrected = with_filtered_biases(model, turning_sensors(), {});
  EXPECT_NEAR(bias_error(corrected), bias_error(model), 2e-5);
}

TEST(FilteredBiases, TheGeometryKeepsItsCovariance) {
  const TrackingModel model = hinge(0.017, 1e-4), corrected = with_filtered_biases(model, turning_sensors(), {});
  const MatrixXd change = corrected.covariance - model.covariance;
  EXPECT_LT(change.topLeftCorner(3, 3).norm(), 1e-12);
  EXPECT_GT(symmetric_eigen(corrected.covariance).values.minCoeff(), -1e-12);
}

TEST(FilteredBiases, AStillBaseKeepsThoseOfTheFit) {
  TrackingModel model = hinge(0.017, 1e-4);
  model.base.moved = false;
  EXPECT_EQ(bias_error(with_filtered_biases(model, turning_sensors(), {})), bias_error(model));
}

}  // namespace
}  // namespace kinfer
