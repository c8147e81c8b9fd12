#include "kinfer/inertial/kinfer_filter.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/square.hpp"

namespace kinfer {
namespace {

constexpr int heading_state = 2, velocity_state = 3, bias_state = 5, scale_state = 8, constants = 12;

/// exp of half a rotation vector as a quaternion; four series terms are exact to 1e-13 below 0.3 rad, where the
/// half steps of any usable recording lie.
Quat half_step(const Vec3& half) {
  const double square = 0.25 * half.squaredNorm();  // of half the angle of this step
  if (square > 0.0225) return quat_exp(half);
  const double sinc = 1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0)));
  const double cosine = 1.0 - square / 2.0 * (1.0 - square / 12.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0)));
  const Vec3 v = 0.5 * sinc * half;
  return {cosine, v.x(), v.y(), v.z()};
}

Quat tilt_of(const Vec3& acceleration) {
  const double norm = acceleration.norm();
  if (!(norm > 0.0)) return Quat::Identity();
  return Quat::FromTwoVectors(acceleration / norm, Vec3::UnitZ());
}

/// Angle by which the world must be turned about up so that the field points north.
double turn_to_north(const Vec3& field_world) {
  return std::atan2(field_world.x(), field_world.y());
}

}  // namespace

KinferBelief corrected(const KinferBelief& belief, const KinferVector& error) {
  KinferBelief out = belief;
  out.world_q_sensor = (quat_exp(Vec3(error.head<3>())) * belief.world_q_sensor).normalized();
  out.velocity += error.segment<2>(velocity_state);
  out.bias += error.segment<3>(bias_state);
  for (int i = 0; i < 9; ++i) out.scale(i / 3, i % 3) += error[scale_state + i];
  return out;
}

KinferVector difference(const KinferBelief& to, const KinferBelief& from) {
  KinferVector error;
  error.head<3>() = quat_log(to.world_q_sensor * from.world_q_sensor.conjugate());
  error.segment<2>(velocity_state) = to.velocity - from.velocity;
  error.segment<3>(bias_state) = to.bias - from.bias;
  for (int i = 0; i < 9; ++i) error[scale_state + i] = to.scale(i / 3, i % 3) - from.scale(i / 3, i % 3);
  return error;
}

KinferFilter::KinferFilter(const KinferFilterOptions& options) : options_(options) {
  constexpr double smallest_scale_sd = 1e-8;  // keeps the covariance regular where no scale errors are wanted
  KinferVector variance;
  variance.setConstant(square(std::max(options.scale_sd, smallest_scale_sd)));
  variance.head<2>().setConstant(square(options.start_tilt_sd));
  variance[heading_state] = square(options.start_heading_sd);
  variance.segment<2>(velocity_state).setConstant(square(options.speed));
  variance.segment<3>(bias_state).setConstant(square(options.bias_sd));
  covariance_.diagonal() = variance;
}

void KinferFilter::start(const InsSample& sample) {
  if (!sample.has_acceleration) return;
  belief_.world_q_sensor = tilt_of(sample.acceleration);
  if (sample.has_field && options_.magnetometer == MagnetometerUse::automatic) {
    const double turn = turn_to_north(belief_.world_q_sensor * sample.field);
    belief_.world_q_sensor = Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ())) * belief_.world_q_sensor;
  }
  last_force_world_ = belief_.world_q_sensor * sample.acceleration;
  if (sample.has_rate) last_rate_ = sample.rate;
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
  return period_.elapsed >= options_.update_period - 0.5 * usual_dt_;
}

void KinferFilter::integrate(const InsSample& sample) {
  if (!started_) return start(sample);
  const double dt = sample.time - time_;
  if (!(dt > 0.0)) return;
  if (!sample.has_rate && dt < options_.longest_hold) return;  // the next rate will stand for this time too
  if (dt >= std::max(options_.longest_hold, 3.0 * usual_dt_) && usual_dt_ > 0.0) return bridge_gap(sample, dt);
  usual_dt_ = usual_dt_ > 0.0 ? usual_dt_ + 0.1 * (std::min(dt, 2.0 * usual_dt_) - usual_dt_) : dt;
  // A sample is the mean rate since the one before; where samples are missing between, the mean of the two is closer.
  const Vec3 rate = dt > 1.6 * usual_dt_ ? Vec3(0.5 * (last_rate_ + sample.rate)) : sample.rate;
  last_rate_ = sample.rate;
  if (sample.rate_clipped) period_.blind_turn += dt;
  turn_and_sum(sample, rate, dt);
  rest_.add(sample, dt, options_.rest);
  time_ = sample.time;
}

void KinferFilter::turn_and_sum(const InsSample& sample, const Vec3& rate, double dt) {
  const Vec3 unbiased = rate - belief_.bias;
  const Vec3 omega = unbiased + belief_.scale * unbiased;
  const Quat step = half_step(0.5 * dt * omega);
  const Quat middle = belief_.world_q_sensor * step;
  belief_.world_q_sensor = middle * step;
  const Mat3 world_r_sensor = middle.toRotationMatrix();
  if (sample.has_acceleration)
    last_force_world_.noalias() = world_r_sensor * sample.acceleration;
  else
    period_.blind_force += dt;
  period_.velocity_gain += dt * last_force_world_;
  period_.rotation += dt * world_r_sensor;
  const Vec3 turn = dt * unbiased;
  for (int i = 0; i < 3; ++i) period_.turn.middleCols<3>(3 * i).noalias() += world_r_sensor.col(i) * turn.transpose();
  period_.rate += dt * rate;
  period_.turned += dt * omega.norm();
  period_.elapsed += dt;
  if (!sample.has_field) return;
  period_.field.noalias() += dt * (world_r_sensor * sample.field);
  period_.field_time += dt;
}

/// After a gap the sensor may be turned in any way: tilt is read anew, heading is known as little as the gap was long.
void KinferFilter::bridge_gap(const InsSample& sample, double dt) {
  period_.blind_turn += dt;
  period_.blind_force += dt;
  period_.elapsed += dt;
  rest_ = {};
  previous_was_still_ = false;
  time_ = sample.time;
  if (sample.has_rate) last_rate_ = sample.rate;
  if (!sample.has_acceleration || !sample.has_rate) return;
  const Vec3 up = belief_.world_q_sensor * sample.acceleration;
  belief_.world_q_sensor = (tilt_of(up) * belief_.world_q_sensor).normalized();
  last_force_world_ = belief_.world_q_sensor * sample.acceleration;
}

KinferTransition KinferFilter::predict() {
  KinferTransition transition;
  auto& a = transition.by_constants;
  a << -period_.rotation, period_.turn;
  transition.lift = period_.velocity_gain.z();
  const double turn_variance = square(options_.gyro_noise) * period_.elapsed +
                               square(options_.turn_noise) * period_.turned +
                               square(options_.blind_noise) * period_.blind_turn;
  transition.noise.head<3>().setConstant(turn_variance);
  transition.noise.segment<2>(velocity_state)
      .setConstant(square(options_.acceleration_noise) * period_.elapsed +
                   square(options_.blind_acceleration) * period_.blind_force);
  transition.noise.segment<3>(bias_state).setConstant(square(options_.bias_drift) * period_.elapsed);

  belief_.world_q_sensor.normalize();
  belief_.velocity += period_.velocity_gain.head<2>();

  // P = F P Fᵀ + Q by blocks: F is the identity but for `a` and `lift`, the constants only gain their drift.
  using Moving = Eigen::Matrix<double, 5, 5>;
  using Cross = Eigen::Matrix<double, 5, constants>;
  const Cross cross = covariance_.topRightCorner<5, constants>();
  const Moving moving = covariance_.topLeftCorner<5, 5>();
  const auto lift_rows = [lift = transition.lift](auto& m) {
    m.row(3) += lift * m.row(1);
    m.row(4) -= lift * m.row(0);
  };
  Cross lifted = cross;
  lift_rows(lifted);
  Cross new_cross = lifted;
  new_cross.topRows<3>().noalias() += a * covariance_.bottomRightCorner<constants, constants>();
  Moving new_moving = moving;
  lift_rows(new_moving);
  new_moving.col(3) += transition.lift * new_moving.col(1);
  new_moving.col(4) -= transition.lift * new_moving.col(0);
  new_moving.leftCols<3>().noalias() += lifted * a.transpose();
  new_moving.topRows<3>().noalias() += a * new_cross.transpose();
  covariance_.topLeftCorner<5, 5>() = 0.5 * (new_moving + new_moving.transpose());
  covariance_.topRightCorner<5, constants>() = new_cross;
  covariance_.bottomLeftCorner<constants, 5>() = new_cross.transpose();
  covariance_.diagonal() += transition.noise;
  return transition;
}

/// Kalman update by a reading of one state: `error` is reading minus belief, before the corrections in `sum`.
void KinferFilter::correct_one(int state, double error, double variance, KinferVector& sum) {
  const KinferVector column = covariance_.col(state);
  const KinferVector gain = column / (column[state] + variance);
  sum += gain * (error - sum[state]);
  covariance_.noalias() -= gain * column.transpose();
}

void KinferFilter::correct() {
  KinferVector sum = KinferVector::Zero();
  const bool still = at_rest() && rest_fits_bias();
  correct_velocity(still, sum);
  if (still) correct_bias(sum);
  if (period_.field_time > 0.0 && options_.magnetometer == MagnetometerUse::automatic) correct_heading(sum);
  belief_ = corrected(belief_, sum);
  const double gain = period_.elapsed / (options_.speed_memory + period_.elapsed);
  constexpr double largest_square_speed = 25.0;  // [m²/s²] so that a tilt error at the start is not taken for speed
  mean_square_speed_ +=
      gain * (std::min(largest_square_speed, 0.5 * belief_.velocity.squaredNorm()) - mean_square_speed_);
  previous_mean_rate_ = period_.rate / period_.elapsed;
  previous_was_still_ = still;
  period_ = {};
}

void KinferFilter::correct_velocity(bool at_rest, KinferVector& sum) {
  const double moving = std::max(square(options_.speed), square(options_.speed_factor) * mean_square_speed_);
  const double variance = at_rest ? square(options_.rest_speed) : moving;
  const double density = 2.0 * options_.speed_time * variance / period_.elapsed;
  for (int i = 0; i < 2; ++i) correct_one(velocity_state + i, -belief_.velocity[i], density, sum);
}

/// By the period before, so that the first movement after a rest does not slip in.
void KinferFilter::correct_bias(KinferVector& sum) {
  if (!previous_was_still_) return;
  const double variance = square(options_.rest_noise) / period_.elapsed;
  for (int i = 0; i < 3; ++i) correct_one(bias_state + i, previous_mean_rate_[i] - belief_.bias[i], variance, sum);
}

/// A slow steady turn looks like a rest, but not like the bias known so far.
bool KinferFilter::rest_fits_bias() const {
  if (rest_.still > options_.longest_doubt) return true;
  const Vec3 sd = covariance_.diagonal().segment<3>(bias_state).cwiseSqrt();
  const Vec3 distance = rest_.slow_rate.value - belief_.bias;
  return ((distance.cwiseAbs() - 5.0 * sd).array() < options_.bias_gate).all();
}

void KinferFilter::correct_heading(KinferVector& sum) {
  const Vec3 field_world = period_.field / period_.field_time;
  const double factor = magnetic_.noise_factor(field_world, period_.turned, period_.elapsed, options_.magnetic);
  const double turn = turn_to_north(field_world);
  if (factor <= 0.0) return;
  correct_one(heading_state, turn, square(factor * options_.field_noise) / period_.elapsed, sum);
}

}  // namespace kinfer
