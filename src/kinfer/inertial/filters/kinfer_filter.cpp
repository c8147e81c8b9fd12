// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/filters/kinfer_filter.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/square.hpp"

namespace kinfer {
namespace {

constexpr int heading_state = 2, velocity_state = 3, bias_state = 5, scale_state = 8, gyro_error_states = 12;

/// Quaternion of half a rotation vector; four series terms are exact to 1e-13 below 0.3 rad, which covers the half
/// steps of any usable recording.
Quat half_vector_quaternion(const Vec3& half) {
  const double square = 0.25 * half.squaredNorm();  // of half the angle of this step
  if (square > 0.0225) return quat_exp(half);
  const double sinc = 1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0)));
  const double cosine = 1.0 - square / 2.0 * (1.0 - square / 12.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0)));
  const Vec3 v = 0.5 * sinc * half;
  return {cosine, v.x(), v.y(), v.z()};
}

Quat levelling_rotation(const Vec3& acceleration) {
  const double norm = acceleration.norm();
  if (!(norm > 0.0)) return Quat::Identity();
  return rotation_between(acceleration / norm, Vec3::UnitZ());
}

/// Rotation of the world about the vertical that aligns the horizontal field with north.
double heading_correction(const Vec3& field_world) {
  return std::atan2(field_world.x(), field_world.y());
}

}  // namespace

KinferEstimate corrected(const KinferEstimate& estimate, const KinferErrorState& error) {
  KinferEstimate out = estimate;
  out.world_q_sensor = (quat_exp(Vec3(error.head<3>())) * estimate.world_q_sensor).normalized();
  out.velocity += error.segment<2>(velocity_state);
  out.bias += error.segment<3>(bias_state);
  for (int i = 0; i < 9; ++i) out.scale(i / 3, i % 3) += error[scale_state + i];
  return out;
}

KinferErrorState difference(const KinferEstimate& to, const KinferEstimate& from) {
  KinferErrorState error;
  error.head<3>() = quat_log(to.world_q_sensor * from.world_q_sensor.conjugate());
  error.segment<2>(velocity_state) = to.velocity - from.velocity;
  error.segment<3>(bias_state) = to.bias - from.bias;
  for (int i = 0; i < 9; ++i) error[scale_state + i] = to.scale(i / 3, i % 3) - from.scale(i / 3, i % 3);
  return error;
}

KinferFilter::KinferFilter(const KinferFilterOptions& options) : options_(options) {
  constexpr double smallest_scale_sd = 1e-8;  // keeps the covariance regular if no scale errors are estimated
  KinferErrorState variance;
  variance.setConstant(square(std::max(options.scale_sd, smallest_scale_sd)));
  variance.head<2>().setConstant(square(options.start_tilt_sd));
  variance[heading_state] = square(options.start_heading_sd);
  variance.segment<2>(velocity_state).setConstant(square(options.speed));
  variance.segment<3>(bias_state).setConstant(square(options.bias_sd));
  covariance_.diagonal() = variance;
  estimate_.bias = options.bias;
  rest_has_told_bias_ = options.bias_sd < options.moment_bias_sd;
}

void KinferFilter::start(const InsSample& sample) {
  if (!sample.has_acceleration) return;
  estimate_.world_q_sensor = levelling_rotation(sample.acceleration);
  if (sample.has_field && options_.magnetometer == MagnetometerUse::automatic) {
    const double turn = heading_correction(estimate_.world_q_sensor * sample.field);
    estimate_.world_q_sensor = Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ())) * estimate_.world_q_sensor;
  }
  last_force_world_ = estimate_.world_q_sensor * sample.acceleration;
  if (sample.has_angular_velocity) last_rate_ = sample.angular_velocity;
  time_ = sample.time;
  started_ = true;
}

void KinferFilter::add(const InsSample& sample) {
  integrate(sample);
  if (!update_is_due()) return;
  predict();
  correct();
}

bool KinferFilter::update_is_due() const {
  return period_.elapsed > 0.0 && period_.elapsed >= options_.update_period - 0.5 * typical_dt_;
}

void KinferFilter::integrate(const InsSample& sample) {
  if (!started_) return start(sample);
  const double dt = sample.time - time_;
  if (!(dt > 0.0)) return;
  const bool is_gap = dt >= std::max(options_.max_hold, 3.0 * typical_dt_);
  if (!sample.has_angular_velocity && !is_gap) return;  // the next rate will cover this time too
  if (is_gap && (typical_dt_ > 0.0 || !sample.has_angular_velocity)) return bridge_gap(sample, dt);
  typical_dt_ = typical_dt_ > 0.0 ? typical_dt_ + 0.1 * (std::min(dt, 2.0 * typical_dt_) - typical_dt_) : dt;
  // Where samples are missing in between, that of the neighbours is the best mean whatever a sample is.
  const bool takes_mean = options_.rate_sample == RateSample::at_its_time || dt > 1.6 * typical_dt_;
  const Vec3 angular_velocity =
      takes_mean ? Vec3(0.5 * (last_rate_ + sample.angular_velocity)) : sample.angular_velocity;
  last_rate_ = sample.angular_velocity;
  if (sample.angular_velocity_clipped) period_.rate_outage += dt;
  integrate_sample(sample, angular_velocity, dt);
  rest_.add(sample, dt, options_.rest);
  time_ = sample.time;
}

void KinferFilter::integrate_sample(const InsSample& sample, const Vec3& angular_velocity, double dt) {
  const Vec3 unbiased = angular_velocity - estimate_.bias;
  const Vec3 omega = unbiased + estimate_.scale * unbiased;
  const Quat step = half_vector_quaternion(0.5 * dt * omega);
  const Quat middle = estimate_.world_q_sensor * step;
  estimate_.world_q_sensor = middle * step;
  const Mat3 world_r_sensor = middle.toRotationMatrix();
  if (sample.has_acceleration)
    last_force_world_.noalias() = world_r_sensor * sample.acceleration;
  else
    period_.force_outage += dt;
  period_.velocity_gain += dt * last_force_world_;
  period_.rotation += dt * world_r_sensor;
  const Vec3 turn = dt * unbiased;
  for (int i = 0; i < 3; ++i) period_.turn.middleCols<3>(3 * i).noalias() += world_r_sensor.col(i) * turn.transpose();
  period_.angular_velocity += dt * angular_velocity;
  period_.turned += dt * omega.norm();
  period_.elapsed += dt;
  if (!sample.has_field) return;
  period_.field.noalias() += dt * (world_r_sensor * sample.field);
  period_.field_time += dt;
}

/// After a gap the orientation is unknown: tilt is reset from gravity, heading uncertainty grows with the gap.
void KinferFilter::bridge_gap(const InsSample& sample, double dt) {
  period_.rate_outage += dt;
  period_.force_outage += dt;
  period_.elapsed += dt;
  rest_ = {};
  previous_was_still_ = false;
  time_ = sample.time;
  if (sample.has_angular_velocity) last_rate_ = sample.angular_velocity;
  if (!sample.has_acceleration || !sample.has_angular_velocity) return;
  const Vec3 up = estimate_.world_q_sensor * sample.acceleration;
  estimate_.world_q_sensor = (levelling_rotation(up) * estimate_.world_q_sensor).normalized();
  last_force_world_ = estimate_.world_q_sensor * sample.acceleration;
}

KinferTransition KinferFilter::predict() {
  KinferTransition transition;
  auto& a = transition.rotation_by_gyro_errors;
  a << -period_.rotation, period_.turn;
  transition.velocity_by_tilt = period_.velocity_gain.z();
  const double rotation_variance = square(options_.gyro_noise) * period_.elapsed +
                                   square(options_.rotation_noise) * period_.turned +
                                   square(options_.outage_rotation_noise) * period_.rate_outage;
  transition.noise.head<3>().setConstant(rotation_variance);
  transition.noise.segment<2>(velocity_state)
      .setConstant(square(options_.acceleration_noise) * period_.elapsed +
                   square(options_.outage_acceleration) * period_.force_outage);
  transition.noise.segment<3>(bias_state).setConstant(square(options_.bias_drift) * period_.elapsed);

  estimate_.world_q_sensor.normalize();
  estimate_.velocity += period_.velocity_gain.head<2>();

  // P = F P Fᵀ + Q by blocks: F is the identity except for `a` and `lift`; bias and scale only receive process noise.
  using Moving = Eigen::Matrix<double, 5, 5>;
  using Cross = Eigen::Matrix<double, 5, gyro_error_states>;
  const Cross cross = covariance_.topRightCorner<5, gyro_error_states>();
  const Moving moving = covariance_.topLeftCorner<5, 5>();
  const auto propagate_rows = [velocity_by_tilt = transition.velocity_by_tilt](auto& m) {
    m.row(3) += velocity_by_tilt * m.row(1);
    m.row(4) -= velocity_by_tilt * m.row(0);
  };
  Cross propagated = cross;
  propagate_rows(propagated);
  Cross new_cross = propagated;
  new_cross.topRows<3>().noalias() += a * covariance_.bottomRightCorner<gyro_error_states, gyro_error_states>();
  Moving new_moving = moving;
  propagate_rows(new_moving);
  new_moving.col(3) += transition.velocity_by_tilt * new_moving.col(1);
  new_moving.col(4) -= transition.velocity_by_tilt * new_moving.col(0);
  new_moving.leftCols<3>().noalias() += propagated * a.transpose();
  new_moving.topRows<3>().noalias() += a * new_cross.transpose();
  covariance_.topLeftCorner<5, 5>() = 0.5 * (new_moving + new_moving.transpose());
  covariance_.topRightCorner<5, gyro_error_states>() = new_cross;
  covariance_.bottomLeftCorner<gyro_error_states, 5>() = new_cross.transpose();
  covariance_.diagonal() += transition.noise;
  return transition;
}

/// Kalman update by a measurement of one state: `error` is measurement minus estimate, before the corrections in `sum`.
void KinferFilter::update_state(int state, double error, double variance, KinferErrorState& sum) {
  const KinferErrorState column = covariance_.col(state);
  const KinferErrorState gain = column / (column[state] + variance);
  sum += gain * (error - sum[state]);
  covariance_.noalias() -= gain * column.transpose();
}

void KinferFilter::correct() {
  KinferErrorState sum = KinferErrorState::Zero();
  const bool still = at_rest() && rest_agrees_with_bias();
  correct_velocity(still, sum);
  if (still) correct_bias(sum);
  rest_has_told_bias_ = rest_has_told_bias_ || (still && rest_.still >= min_rest_duration);
  if (period_.field_time > 0.0 && options_.magnetometer == MagnetometerUse::automatic) correct_heading(sum);
  estimate_ = corrected(estimate_, sum);
  const double gain = period_.elapsed / (options_.speed_memory + period_.elapsed);
  constexpr double largest_square_speed = 25.0;  // [m²/s²] so that an initial tilt error is not mistaken for speed
  mean_square_speed_ +=
      gain * (std::min(largest_square_speed, 0.5 * estimate_.velocity.squaredNorm()) - mean_square_speed_);
  previous_mean_rate_ = period_.angular_velocity / period_.elapsed;
  previous_was_still_ = still;
  period_ = {};
}

void KinferFilter::correct_velocity(bool at_rest, KinferErrorState& sum) {
  const double moving = std::max(square(options_.speed), square(options_.speed_factor) * mean_square_speed_);
  const double variance = at_rest ? square(options_.rest_speed) : moving;
  const double density = 2.0 * options_.speed_time * variance / period_.elapsed;
  for (int i = 0; i < 2; ++i) update_state(velocity_state + i, -estimate_.velocity[i], density, sum);
}

/// Uses the previous period, so that the onset of motion after a rest is excluded.
void KinferFilter::correct_bias(KinferErrorState& sum) {
  if (!previous_was_still_) return;
  const double variance = square(options_.rest_noise) / period_.elapsed;
  for (int i = 0; i < 3; ++i) update_state(bias_state + i, previous_mean_rate_[i] - estimate_.bias[i], variance, sum);
}

/// A slow steady rotation looks like rest, but its rate differs from the estimated bias. For a moment any motion does:
/// then a longer rest has to have told the bias, or it has to be known well enough, and the rate has to be near it.
bool KinferFilter::rest_agrees_with_bias() const {
  if (rest_.still > options_.max_rest_rejection) return true;
  const Vec3 sd = covariance_.diagonal().segment<3>(bias_state).cwiseSqrt();
  const bool is_moment = rest_.still < min_rest_duration;
  if (is_moment && !rest_has_told_bias_ && sd.maxCoeff() > options_.moment_bias_sd) return false;
  const Vec3 distance = rest_.slow_rate.value - estimate_.bias;
  const double gate = is_moment ? options_.moment_gate : options_.rest_gate;
  return ((distance.cwiseAbs() - gate * sd).array() < options_.bias_gate).all();
}

void KinferFilter::correct_heading(KinferErrorState& sum) {
  const Vec3 field_world = period_.field / period_.field_time;
  const double factor = magnetic_.noise_factor(field_world, period_.turned, period_.elapsed, options_.magnetic);
  const double turn = heading_correction(field_world);
  if (factor <= 0.0) return;
  update_state(heading_state, turn, square(factor * options_.field_noise) / period_.elapsed, sum);
}

}  // namespace kinfer
