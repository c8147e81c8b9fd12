#include "kinfer/inertial/paper_ekf.hpp"

#include <cmath>

#include "kinfer/base/square.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

constexpr double unknown = 1e6;  // variance of a reading that was not taken, in units of its square

}  // namespace

PaperEkf::PaperEkf(const PaperEkfOptions& options) : options_(options) {
  State variance;
  variance << Vec3::Constant(square(options.start_sd)), Vec3::Constant(square(options.bias_sd)),
      Vec3::Constant(square(options.linear_acceleration)), Vec3::Constant(square(options.disturbance));
  covariance_.diagonal() = variance;
}

void PaperEkf::start(const InsSample& sample) {
  if (!sample.has_acceleration) return;
  world_q_sensor_ = Quat::FromTwoVectors(sample.acceleration.normalized(), Vec3::UnitZ());
  learn_field(sample);
  time_ = sample.time;
  started_ = true;
}

/// m^G and the first heading.
void PaperEkf::learn_field(const InsSample& sample) {
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
  if (!(dt > 0.0) || !sample.has_rate) return;
  if (field_strength_ <= 0.0) learn_field(sample);
  predict(sample.rate, dt);
  update(sample, dt);
  time_ = sample.time;
}

void PaperEkf::predict(const Vec3& rate, double dt) {
  const Vec3 omega = rate - bias_;                                                // the a priori angular velocity
  world_q_sensor_ = (world_q_sensor_ * quat_exp(Vec3(omega * dt))).normalized();  // eqs. (5), (14)
  const double keep_acceleration = std::exp(-dt / options_.linear_time);
  const double keep_disturbance = std::exp(-dt / options_.disturbance_time);
  acceleration_ *= keep_acceleration;
  disturbance_ *= keep_disturbance;

  Covariance f = Covariance::Identity();  // eq. (7)
  f.topLeftCorner<3, 3>() = exp_so3(Vec3(-omega * dt));
  f.block<3, 3>(0, 3) = -dt * Mat3::Identity();  // λ grows by minus the error of the bias
  f.diagonal().segment<3>(6).setConstant(keep_acceleration);
  f.diagonal().segment<3>(9).setConstant(keep_disturbance);
  State q;
  q << Vec3::Constant(square(options_.gyro_noise) * dt), Vec3::Constant(square(options_.bias_drift) * dt),
      Vec3::Constant(square(options_.linear_acceleration) * (1.0 - square(keep_acceleration))),
      Vec3::Constant(square(options_.disturbance) * (1.0 - square(keep_disturbance)));
  covariance_ = f * covariance_ * f.transpose();  // eq. (6)
  covariance_.diagonal() += q;
}

/// ŷ of eqs. (8), (15): measured gravity and field minus those that the orientation predicts, in the sensor. Over their
/// strengths, so that both are plain numbers.
PaperEkf::Reading PaperEkf::residual(const InsSample& sample) const {
  const Quat sensor_q_world = world_q_sensor_.conjugate();
  Reading y;
  y.head<3>() = sample.acceleration + acceleration_ - sensor_q_world * Vec3(0.0, 0.0, gravity_);  // + Â: see the header
  if (field_strength_ > 0.0)
    y.tail<3>() = sample.field / field_strength_ - disturbance_ - sensor_q_world * field_world_;
  else
    y.tail<3>().setZero();
  return y;
}

/// H of eq. (12). With R̂ = exp(-λ) R_true: R_true g - R̂ g = λ × g = -[g ×] λ, and likewise for the field.
PaperEkf::Model PaperEkf::reading_by_error() const {
  const Quat sensor_q_world = world_q_sensor_.conjugate();
  Model h = Model::Zero();
  h.block<3, 3>(0, 0) = -skew(sensor_q_world * Vec3(0.0, 0.0, gravity_));
  h.block<3, 3>(0, 6) = Mat3::Identity();
  h.block<3, 3>(3, 0) = -skew(sensor_q_world * field_world_);
  h.block<3, 3>(3, 9) = -Mat3::Identity();
  return h;
}

/// Diagonal of R_k; a reading that was not taken has no weight.
PaperEkf::Reading PaperEkf::noise(const InsSample& sample, double dt) const {
  const bool reads_field = sample.has_field && options_.magnetometer == MagnetometerUse::automatic;
  Reading r;
  r.head<3>().setConstant(sample.has_acceleration ? square(options_.acceleration_noise) / dt : unknown);
  r.tail<3>().setConstant(reads_field ? square(options_.field_noise) / dt : unknown);
  return r;
}

void PaperEkf::update(const InsSample& sample, double dt) {
  const Reading r = noise(sample, dt);
  State error = State::Zero();  // x̂^ε so far; eq. (10) starts from zero, all of it is in the nominal values
  Covariance posterior = covariance_;
  for (int pass = 0; pass < options_.iterations; ++pass) {
    const Model h = reading_by_error();
    const MatrixXd s = h * covariance_ * h.transpose() + Eigen::Matrix<double, 6, 6>(r.asDiagonal());
    const auto inverse = inverse_positive(s);
    if (!inverse) return;
    const Eigen::Matrix<double, 12, 6> k = covariance_ * h.transpose() * *inverse;  // eq. (9)
    const State next = k * (residual(sample) + h * error);  // eq. (10); `error` is in the nominal
    const State step = next - error;
    world_q_sensor_ = (world_q_sensor_ * quat_exp(Vec3(-step.head<3>()))).normalized();  // eq. (16)
    bias_ -= step.segment<3>(3);                                                         // eq. (17)
    acceleration_ -= step.segment<3>(6);
    disturbance_ -= step.tail<3>();
    error = next;
    posterior = (Covariance::Identity() - k * h) * covariance_;  // eq. (11)
  }
  covariance_ = 0.5 * (posterior + posterior.transpose());
}

}  // namespace kinfer
