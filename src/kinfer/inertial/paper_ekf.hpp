// Paper 1's orientation filter (Péntek et al. 2021, section III-A, eqs. 3-17): an error-state Kalman filter of 12
// states, orientation error, gyro bias, linear acceleration and magnetic disturbance, with full covariance.
//
// What the paper leaves open, as this house reads it:
// - An error is estimate minus truth, because eqs. (16) and (17) subtract it: q⁻ = q_true ⊗ quat(λ), b⁻ = b_true + b^ε.
// - Eq. (15) ADDS Â to the accelerometer: the accelerometer reads +g upward at rest, so Â is minus the linear
// acceleration.
// - R̂ in eq. (15) turns the world into the sensor, the inverse of q̂, which turns the sensor into the world.
// - "quat()" of eq. (14) is said to take Euler angles; for the small angles of one sample it is the rotation vector's
//   quaternion to second order, and the exact one for a constant rate, so the rotation vector is taken.
// - Between samples Â and m̂ decay as exp(-dt/τ): time constants in seconds, so that the rate does not matter.
// - m^G is the field of the first sample, turned into the world by its tilt, with its east part put to zero.
#pragma once

#include "kinfer/inertial/filter_input.hpp"

namespace kinfer {

/// The paper's Table 2, which feeds R_k, is lost: these are figures tuned on BROAD trials
/// (docs/methods/orientation.md).
struct PaperEkfOptions {
  MagnetometerUse magnetometer = MagnetometerUse::automatic;  ///< off: the last three rows of eq. (15) carry no weight
  int iterations = 1;                ///< passes of the update, eqs. (8)-(12); 1 is eqs. (8)-(12) as printed
  double gyro_noise = 3e-2;          ///< [rad/√s]; larger trusts specific force and field more
  double bias_sd = 8.7e-3;           ///< [rad/s] at the start
  double bias_drift = 3e-5;          ///< [rad/s/√s]
  double acceleration_noise = 2.0;   ///< [m/s/√s]
  double linear_acceleration = 0.1;  ///< [m/s²] its standard deviation
  double linear_time = 0.2;          ///< [s] its correlation time
  double field_noise = 0.05;         ///< [√s] of the field's strength
  double disturbance = 0.035;        ///< of the field's strength: standard deviation of the disturbance
  double disturbance_time = 5.0;     ///< [s] its correlation time
  double start_sd = 0.1;             ///< [rad] of the first orientation
};

/// Streams; copyable.
class PaperEkf {
 public:
  explicit PaperEkf(const PaperEkfOptions& options = {});
  void add(const InsSample& sample);
  const Quat& orientation() const { return world_q_sensor_; }
  bool started() const { return started_; }
  const Vec3& bias() const { return bias_; }

 private:
  using State = Eigen::Matrix<double, 12, 1>;  // λ, b, A, M errors: eq. (13)
  using Covariance = Eigen::Matrix<double, 12, 12>;
  using Reading = Eigen::Matrix<double, 6, 1>;
  using Model = Eigen::Matrix<double, 6, 12>;

  void start(const InsSample& sample);
  void learn_field(const InsSample& sample);
  void predict(const Vec3& rate, double dt);
  void update(const InsSample& sample, double dt);
  Reading residual(const InsSample& sample) const;
  Model reading_by_error() const;
  Reading noise(const InsSample& sample, double dt) const;

  PaperEkfOptions options_;
  Quat world_q_sensor_ = Quat::Identity();
  Vec3 bias_ = Vec3::Zero(), acceleration_ = Vec3::Zero(), disturbance_ = Vec3::Zero();
  Vec3 field_world_ = Vec3::Zero();  // m^G over its strength
  double field_strength_ = 0.0, gravity_ = 9.81;
  Covariance covariance_ = Covariance::Zero();
  double time_ = 0.0;
  bool started_ = false;
};

}  // namespace kinfer
