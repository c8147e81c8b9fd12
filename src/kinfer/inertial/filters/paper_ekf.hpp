// SPDX-License-Identifier: Apache-2.0
// Paper 1's orientation filter (Péntek et al. 2021, section III-A, eqs. 3-17): an error-state Kalman filter of 12
// states: orientation error, gyro bias, linear acceleration and magnetic disturbance, with full covariance.
//
// Interpretation of what the paper leaves open:
// - An error is estimate minus truth, because eqs. (16) and (17) subtract it: q⁻ = q_true ⊗ quat(λ), b⁻ = b_true + b^ε.
// - Eq. (15) adds Â to the accelerometer, which measures +g upward at rest, so Â is minus the linear acceleration.
// - R̂ in eq. (15) transforms from world to sensor; it is the inverse of q̂, which transforms from sensor to world.
// - The paper lets "quat()" of eq. (14) take Euler angles; for the small angles of one sample they agree with the
//   rotation vector to second order. The rotation vector is used, which is exact for a constant rate.
// - Between samples Â and m̂ decay as exp(-dt/τ), with τ in seconds, so that the result does not depend on the sampling
//   rate.
// - m^G is the field of the first sample, transformed to the world by its tilt, with the east component set to zero.
#pragma once

#include "kinfer/inertial/filters/magnetometer_use.hpp"

namespace kinfer {

/// The paper's Table 2, which feeds R_k, is not available: these values were tuned on BROAD trials
/// (docs/development/methods/orientation.md).
struct PaperEkfOptions {
  MagnetometerUse magnetometer = MagnetometerUse::automatic;  ///< off: the last three rows of eq. (15) have no weight
  int iterations = 1;                                         ///< of the update, eqs. (8)-(12); 1: as printed
  double gyro_noise = 3e-2;          ///< [rad/√s]; larger trusts specific force and field more
  double bias_sd = 8.7e-3;           ///< [rad/s] initial
  double bias_drift = 3e-5;          ///< [rad/s/√s]
  double acceleration_noise = 2.0;   ///< [m/s/√s]
  double linear_acceleration = 0.1;  ///< [m/s²] standard deviation
  double linear_time = 0.2;          ///< [s] correlation time
  double field_noise = 0.05;         ///< [√s] relative to the field strength
  double disturbance = 0.035;        ///< standard deviation, relative to the field strength
  double disturbance_time = 5.0;     ///< [s] correlation time
  double start_sd = 0.1;             ///< [rad] initial orientation
};

/// Online; copyable.
class PaperEkf {
 public:
  explicit PaperEkf(const PaperEkfOptions& options = {});
  void add(const InsSample& sample);
  const Quat& orientation() const { return world_q_sensor_; }
  bool started() const { return started_; }

 private:
  using State = Eigen::Matrix<double, 12, 1>;  // λ, b, A, M errors: eq. (13)
  using Covariance = Eigen::Matrix<double, 12, 12>;
  using Measurement = Eigen::Matrix<double, 6, 1>;
  using MeasurementMatrix = Eigen::Matrix<double, 6, 12>;

  void start(const InsSample& sample);
  void set_reference_field(const InsSample& sample);
  void predict(const Vec3& angular_velocity, double dt);
  void update(const InsSample& sample, double dt);
  Measurement residual(const InsSample& sample) const;
  MeasurementMatrix measurement_matrix() const;
  Measurement noise(const InsSample& sample, double dt) const;

  PaperEkfOptions options_;
  Quat world_q_sensor_ = Quat::Identity();
  Vec3 bias_ = Vec3::Zero(), acceleration_ = Vec3::Zero(), disturbance_ = Vec3::Zero();
  Vec3 field_world_ = Vec3::Zero();  // m^G, unit length
  double field_strength_ = 0.0;
  Covariance covariance_ = Covariance::Zero();
  double time_ = 0.0;
  bool started_ = false;
};

}  // namespace kinfer
