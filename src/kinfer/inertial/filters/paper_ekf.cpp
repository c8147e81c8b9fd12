// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/filters/paper_ekf.hpp"

#include <cmath>

#include "kinfer/base/constants.hpp"
#include "kinfer/base/square.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer {
namespace {

constexpr double missing_variance = 1e6;  // variance of a missing measurement, in units of its square

}  // namespace

PaperEkf::PaperEkf(const PaperEkfOptions& options) : options_(options) {
  State variance;
  variance << Vec3::Constant(square(options.start_sd)), Vec3::Constant(square(options.bias_sd)),
      Vec3::Constant(square(options.linear_acceleration)), Vec3::Constant(square(options.disturbance));
  covariance_.diagonal() = variance;
}

void PaperEkf::start(const InsSample& sample) {
  if (!sample.has_acceleration) return;
  world_q_sensor_ = rotation_between(sample.acceleration.normalized(), Vec3::UnitZ());
  set_reference_field(sample);
  time_ = sample.time;
  started_ = true;
}

/// m^G and the first heading.
void PaperEkf::set_reference_field(const InsSample& sample) {
  if (!sample.has_field || options_.magnetometer == MagnetometerUse::off) return;
  const Vec3 field = world_q_sensor_ * sample.field;
  field_strength_ = field.norm();
  field_world_ = Vec3(0.0, std::hypot(field.x(), field.y()), field.z()) / field_strength_;
  const double turn = std::atan2(field.x(), field.y());
  world_q_sensor_ = Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ())) * world_q_sensor_;
}

void PaperEkf::add(const InsSample& sample) {
  if (!started_) return start(sample);
  const double dt = sample.time - time_;
  if (!(dt > 0.0) || !sample.has_angular_velocity) return;
  if (field_strength_ <= 0.0) set_reference_field(sample);
  predict(sample.angular_velocity, dt);
  update(sample, dt);
  time_ = sample.time;
}

void PaperEkf::predict(const Vec3& angular_velocity, double dt) {
  const Vec3 omega = angular_velocity - bias_;                                    // the a priori angular velocity
  world_q_sensor_ = (world_q_sensor_ * quat_exp(Vec3(omega * dt))).normalized();  // eqs. (5), (14)
  const double keep_acceleration = std::exp(-dt / options_.linear_time);
  const double keep_disturbance = std::exp(-dt / options_.disturbance_time);
  acceleration_ *= keep_acceleration;
  disturbance_ *= keep_disturbance;

  Covariance f = Covariance::Identity();  // eq. (7)
  f.topLeftCorner<3, 3>() = exp_so3(Vec3(-omega * dt));
  f.block<3, 3>(0, 3) = -dt * Mat3::Identity();  // λ decreases by the bias error
  f.diagonal().segment<3>(6).setConstant(keep_acceleration);
  f.diagonal().segment<3>(9).setConstant(keep_disturbance);
  State q;
  q << Vec3::Constant(square(options_.gyro_noise) * dt), Vec3::Constant(square(options_.bias_drift) * dt),
      Vec3::Constant(square(options_.linear_acceleration) * (1.0 - square(keep_acceleration))),
      Vec3::Constant(square(options_.disturbance) * (1.0 - square(keep_disturbance)));
  covariance_ = propagated_covariance(f, covariance_);  // eq. (6)
  covariance_.diagonal() += q;
}

/// ŷ of eqs. (8), (15): measured minus predicted specific force [m/s²] and field (relative to its strength), in the
/// sensor frame.
PaperEkf::Measurement PaperEkf::residual(const InsSample& sample) const {
  const Quat sensor_q_world = world_q_sensor_.conjugate();
  Measurement y;
  y.head<3>() =
      sample.acceleration + acceleration_ - sensor_q_world * Vec3(0.0, 0.0, standard_gravity);  // + Â: see the header
  if (field_strength_ > 0.0)
    y.tail<3>() = sample.field / field_strength_ - disturbance_ - sensor_q_world * field_world_;
  else
    y.tail<3>().setZero();
  return y;
}

/// H of eq. (12). With R̂ = exp(-λ) R_true: R_true g - R̂ g = λ × g = -[g ×] λ, and likewise for the field.
PaperEkf::MeasurementMatrix PaperEkf::measurement_matrix() const {
  const Quat sensor_q_world = world_q_sensor_.conjugate();
  MeasurementMatrix h = MeasurementMatrix::Zero();
  h.block<3, 3>(0, 0) = -skew(sensor_q_world * Vec3(0.0, 0.0, standard_gravity));
  h.block<3, 3>(0, 6) = Mat3::Identity();
  h.block<3, 3>(3, 0) = -skew(sensor_q_world * field_world_);
  h.block<3, 3>(3, 9) = -Mat3::Identity();
  return h;
}

/// Diagonal of R_k; a missing measurement has no weight.
PaperEkf::Measurement PaperEkf::noise(const InsSample& sample, double dt) const {
  const bool reads_field = sample.has_field && options_.magnetometer == MagnetometerUse::automatic;
  Measurement r;
  r.head<3>().setConstant(sample.has_acceleration ? square(options_.acceleration_noise) / dt : missing_variance);
  r.tail<3>().setConstant(reads_field ? square(options_.field_noise) / dt : missing_variance);
  return r;
}

void PaperEkf::update(const InsSample& sample, double dt) {
  const Measurement r = noise(sample, dt);
  State error = State::Zero();  // x̂^ε so far; eq. (10) starts from zero, as the nominal state already includes it
  Covariance posterior = covariance_;
  for (int pass = 0; pass < options_.iterations; ++pass) {
    const MeasurementMatrix h = measurement_matrix();
    MatrixXd s = propagated_covariance(h, covariance_);
    s.diagonal() += r;
    const auto inverse = invert_spd(s);
    if (!inverse) return;
    const MatrixXd k = product(times_transposed(covariance_, h), *inverse);  // eq. (9)
    const State next = k * (residual(sample) + h * error);                   // eq. (10); `error` is in the nominal
    const State step = next - error;
    world_q_sensor_ = (world_q_sensor_ * quat_exp(Vec3(-step.head<3>()))).normalized();  // eq. (16)
    bias_ -= step.segment<3>(3);                                                         // eq. (17)
    acceleration_ -= step.segment<3>(6);
    disturbance_ -= step.tail<3>();
    error = next;
    posterior = product(Covariance::Identity() - product(k, h), covariance_);  // eq. (11)
  }
  covariance_ = 0.5 * (posterior + posterior.transpose());
}

}  // namespace kinfer
