// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/filter/chain_filter.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/square.hpp"
#include "kinfer/linalg/small_cholesky.hpp"
#include "kinfer/track/filter/thresholds.hpp"

namespace kinfer::track {
namespace {

/// Variance of a block's mean: white noise averages out, what persists over the block does not, and what persists over
/// many blocks is worth more white noise than either.
double block_variance(double white, double persistent, double slow, double sample_period, double length, int count) {
  return std::max(square(white) / count + square(persistent), square(slow) * sample_period / length);
}

using SensorVector = Eigen::Matrix<double, sensor_rows, 1>;
using SensorMatrix = Eigen::Matrix<double, sensor_rows, sensor_rows>;

/// vᵀ m⁻¹ v by elimination.
double squared_distance(SensorVector v, SensorMatrix m) {
  double t = 0.0;
  for (Index k = 0; k < sensor_rows; ++k) {
    t += v[k] * v[k] / m(k, k);
    for (Index i = k + 1; i < sensor_rows; ++i) {
      const double factor = m(i, k) / m(k, k);
      v[i] -= factor * v[k];
      for (Index j = k + 1; j < sensor_rows; ++j) m(i, j) -= factor * m(k, j);
    }
  }
  return t;
}

/// Of an even number the lower of the middle two; reorders.
double lower_median(std::span<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

ChainFilter::ChainFilter(std::shared_ptr<const FilterModel> model)
    : model_(std::move(model)), state_(initial_state(*model_)), evaluator_(*model_), changes_(*model_) {
  const FilterLayout& layout = model_->layout;
  const auto sensors = static_cast<std::size_t>(layout.sensors);
  const Index most = layout.rows() + 3 + 2 * static_cast<Index>(model_->loose.size() + model_->prismatic.size()) +
                     static_cast<Index>(model_->revolute.size());
  p_ = MatrixXd::Zero(layout.size, layout.size);
  p_.bottomRightCorner(layout.size - layout.fast, layout.size - layout.fast) = model_->parameters;
  is_used_.assign(sensors, true);
  last_value_ = change_ = VectorXd::Zero(layout.rows());
  steady_.assign(model_->prismatic.size() + model_->revolute.size(), {});
  inflation_.assign(sensors, {1.0, 1.0});
  innovations_.value = VectorXd::Zero(layout.rows());
  innovations_.leave_out.assign(sensors, 0.0);
  innovations_.rows.assign(sensors, 0);
  innovations_.lateness.assign(sensors, {});
  innovations_.of_joint.assign(model_->joints.size(), 0.0);
  innovations_.unlimited = innovations_.leave_out;
  innovations_.unlimited_of_joint = innovations_.of_joint;
  residual_ = noise_ = whitened_ = VectorXd::Zero(most);
  error_ = VectorXd::Zero(layout.size);
  h_ = MatrixXd::Zero(most, layout.fast);
  w_ = MatrixXd::Zero(layout.size, most);
  unused_w_ = MatrixXd::Zero(layout.size, sensor_rows);
  s_ = kept_ = inverse_ = MatrixXd::Zero(most, most);
  accelerations_ = MatrixXd::Zero(layout.positions + 6, layout.positions + 6);
  leave_out_.assign(2 * sensors, 1.0);
  ordered_.assign(sensors, 0.0);
  is_measured_.assign(static_cast<std::size_t>(2 * layout.sensors), false);
}

void ChainFilter::start(const ChainState& state, ConstMatrixRef fast) {
  const FilterLayout& layout = model_->layout;
  KINFER_EXPECT(fast.rows() == layout.fast && fast.cols() == layout.fast);
  std::vector<SensorErrors> sensors = std::move(state_.sensors);
  state_ = state;
  state_.sensors = std::move(sensors);
  placed_ = state.time;
  p_.leftCols(layout.fast).setZero();
  p_.topRows(layout.fast).setZero();
  p_.topLeftCorner(layout.fast, layout.fast) = fast;
}

/// The state of the zero of a revolute joint's positions; −1: it is not considered.
Index ChainFilter::zero_state(Index position) const {
  const auto at = std::ranges::find(model_->layout.position, position);
  const auto b = static_cast<std::size_t>(at - model_->layout.position.begin());
  if (b >= model_->bodies.size()) return -1;
  const InsBody& body = model_->bodies[b];
  if (body.motion != JointMotion::revolute || !body.free_child_rotation[2]) return -1;
  return model_->layout.first_geometry + model_->layout.geometry[b] + body.turns() - 1;
}

void ChainFilter::forget(Index state) {
  p_.row(state).setZero();
  p_.col(state).setZero();
}

void ChainFilter::place(Index position, double value, double sd) {
  const Index at = model_->layout.joint_state(position), zero = zero_state(position);
  forget(at);
  placed_ = state_.time;
  if (zero >= 0 && p_(zero, zero) <= 0.0)
    p_(zero, zero) = model_->parameters(zero - model_->layout.fast, zero - model_->layout.fast);
  state_.joints[position_states * position] = value;
  p_(at, at) = sd * sd;
}

void ChainFilter::declare_known(Index position) {
  placed_ = state_.time;
  forget(model_->layout.joint_state(position));
  if (const Index zero = zero_state(position); zero >= 0) forget(zero);
}

void ChainFilter::predict(double time) {
  while (time - state_.time > 1e-9) {
    const double dt = std::min(time - state_.time, longest_step);
    predict_covariance(*model_, state_, dt, p_);
    add_posture_walk(dt);
    predict_mean(*model_, dt, state_);
  }
}

/// Axes that are off by an angle that is considered, and not estimated, show as an acceleration that changes with the
/// posture. To a bias that was found in another posture it is a random walk with the angle turned through.
void ChainFilter::add_posture_walk(double dt) {
  const std::vector<Vec3>& rates = evaluator_.result().angular_velocity;
  for (std::size_t s = 0; s < model_->sensors.size(); ++s) {
    const double per_turn = posture_walk * square(model_->gravity * model_->sensors[s].axis_sd);
    const Index bias = model_->layout.sensor_state(static_cast<Index>(s)) + SensorIndex::accelerometer_bias;
    p_.diagonal().segment<3>(bias).array() += dt * rates[s].norm() * per_turn;
  }
}

void ChainFilter::set_base(BaseMode mode) {
  if (state_.base == mode) return;
  state_.base = mode;
  // The first moments of motion are unknown: what the processes allow.
  const auto set = [&](Index first, double sd) { p_.diagonal().segment<3>(first).array() += sd * sd; };
  if (mode == BaseMode::still) return;
  set(BaseIndex::rate, model_->base_rotation.sd * model_->base_rotation.time);
  set(BaseIndex::angular_acceleration, model_->base_rotation.sd);
  set(BaseIndex::velocity, base_velocity_sd);
  set(BaseIndex::acceleration, model_->base_translation.sd);
}

void ChainFilter::form_sensor_rows(const BlockMeasurement& block, std::size_t s) {
  const BlockSample& measured = block.sensors[s];
  const SensorSettings& settings = model_->sensors[s];
  const Index row = sensor_rows * static_cast<Index>(s);
  const auto set = [&](Index first, int count, const Vec3& value, double white, double persistent, double slow,
                       double inflation) {
    const bool is_measured = is_used_[s] && count > 0;
    is_measured_[static_cast<std::size_t>(first / 3)] = is_measured;
    innovations_.value.segment<3>(first) = value - evaluator_.result().value.segment<3>(first);
    // A row without derivatives, residual and correlation changes nothing.
    residual_.segment<3>(first) = is_measured ? Vec3(innovations_.value.segment<3>(first)) : Vec3(Vec3::Zero());
    noise_.segment<3>(first).setConstant(
        is_measured ? inflation * block_variance(white, persistent, slow, settings.sample_period, block.length, count)
                    : 1.0);
    if (!is_measured) h_.middleRows(first, 3).setZero();
  };
  set(row, measured.rate_count, measured.rate, settings.white.rate, settings.persistent.rate, settings.slow.rate,
      inflation_[s].rate);
  set(row + 3, measured.force_count, measured.force, settings.white.force, settings.persistent.force,
      settings.slow.force, inflation_[s].force);
}

/// A moving base stays about where it is, a prismatic joint in its range, and the axes of a loose revolute joint about
/// aligned: N(0, σ²) with a correlation time τ is worth white noise of variance σ² 2τ/length in each block.
void ChainFilter::form_soft_rows(double length) {
  rows_ = model_->layout.rows();
  const auto worth = [&](double sd, double time) { return sd * sd * std::max(1.0, 2.0 * time / length); };
  const auto append = [&](double innovation, double variance) {
    h_.row(rows_).setZero();
    residual_[rows_] = innovation;
    noise_[rows_] = variance;
    return rows_++;
  };
  if (state_.base == BaseMode::moving)
    for (Index k = 0; k < 3; ++k)
      h_(append(-state_.velocity[k], worth(base_velocity_sd, base_velocity_time)), BaseIndex::velocity + k) = 1.0;
  for (std::size_t k = 0; k < model_->prismatic.size(); ++k) {
    const PrismaticRange& range = model_->prismatic[k];
    const double* x = state_.joints.data() + position_states * range.position;
    const Index at = model_->layout.joint_state(range.position);
    const RestOdds odds{range.speed, prismatic_creep, prismatic_steadiness};
    const double speed = rests(steady_[k], range.position, odds, length) ? prismatic_creep : range.speed;
    h_(append(range.middle - x[0], worth(range.half, prismatic_position_time)), at) = 1.0;
    h_(append(-x[1], worth(speed, prismatic_velocity_time)), at + 1) = 1.0;
  }
  for (std::size_t k = 0; k < model_->revolute.size(); ++k) {
    const RevoluteBetweenSensors& joint = model_->revolute[k];
    const RestOdds odds{steady_rate, revolute_creep, revolute_steadiness};
    const bool rests_now = rests(steady_[model_->prismatic.size() + k], joint.position, odds, length),
               is_bridged = !is_measured_[2 * joint.parent_sensor] || !is_measured_[2 * joint.child_sensor];
    if (!rests_now || !is_bridged || !shows_acceleration(joint.position)) continue;
    const Index at = model_->layout.joint_state(joint.position) + 1;
    h_(append(-state_.joints[at - base_states], worth(revolute_creep, revolute_rest_time)), at) = 1.0;
  }
  for (const LooseRevoluteJoint& loose : model_->loose) {
    const Mat3& rotation = state_.spherical[loose.body];
    const Mat3 by_turn = -rotation * skew(Vec3::UnitZ());
    for (Index k = 0; k < 2; ++k) {
      const Index row = append(-rotation(k, 2), worth(loose.stray, loose.time));
      for (Index i = 0; i < 3; ++i)
        h_(row, model_->layout.joint_state(model_->layout.position[loose.body] + i)) = by_turn(k, i);
    }
  }
}

/// A joint rests where its velocity has been the same for a while, by even odds none. A machine's telescope is locked
/// most of the time, and its acceleration, integrated twice, would drift by decimetres; so does the difference of two
/// parallel joints without the sensor between them.
bool ChainFilter::rests(SteadyVelocity& steady, Index position, const RestOdds& odds, double length) const {
  const double velocity = state_.joints[position_states * position + 1];
  const Index at = model_->layout.joint_state(position) + 1;
  const auto log_density = [&](double speed) {
    const double variance = p_(at, at) + square(speed);
    return -0.5 * (square(velocity) / variance + std::log(variance));
  };
  if (std::abs(velocity - steady.velocity) > odds.steadiness) steady = {velocity, 0.0};
  steady.duration += length;
  return steady.duration > joint_rest && log_density(odds.creep) > log_density(odds.speed);
}

/// Whether the sensors that are measured tell a joint's acceleration from those of all others and of the base, by this
/// block alone. Where they do not, a joint that seems to rest may move unseen.
bool ChainFilter::shows_acceleration(Index position) {
  const FilterLayout& layout = model_->layout;
  const Index joints = layout.positions, all = joints + (state_.base == BaseMode::moving ? 6 : 0);
  const auto process_sd = [&](Index k) {
    return k < joints       ? model_->positions[static_cast<std::size_t>(k)].sd
           : k < joints + 3 ? model_->base_rotation.sd
                            : model_->base_translation.sd;
  };
  const auto state_of = [&](Index k) {
    return k < joints       ? layout.joint_state(k) + 2
           : k < joints + 3 ? BaseIndex::angular_acceleration + k - joints
                            : BaseIndex::acceleration + k - joints - 3;
  };
  auto information = accelerations_.topLeftCorner(all, all);
  information.setZero();
  for (Index k = 0; k < all; ++k) {
    information(k, k) = 1.0 / square(process_sd(k));
    for (Index j = 0; j <= k; ++j)
      for (Index row = 0; row < layout.rows(); ++row)
        information(k, j) += h_(row, state_of(k)) * h_(row, state_of(j)) / noise_[row];
  }
  if (!factorise_small(information)) return false;
  // The variance is |L⁻¹ e|².
  double variance = 0.0;
  for (Index i = position; i < all; ++i) {
    double x = i == position ? 1.0 : 0.0;
    for (Index j = position; j < i; ++j) x -= information(i, j) * error_[j];
    error_[i] = x / information(i, i);
    variance += square(error_[i]);
  }
  return variance < shown_acceleration * square(process_sd(position));
}

/// Of the predicted rows; none after a gap.
void ChainFilter::follow_change() {
  const double dt = state_.time - last_update_;
  const VectorXd& value = evaluator_.result().value;
  if (dt > 0.0 && dt <= longest_step)
    change_ = (value - last_value_) / dt;
  else
    change_.setZero();
  last_value_ = value;
  last_update_ = state_.time;
}

void ChainFilter::form_rows(const BlockMeasurement& block) {
  evaluator_.evaluate(*model_, state_);
  follow_change();
  h_.topRows(model_->layout.rows()) = evaluator_.result().by_fast;
  for (std::size_t s = 0; s < is_used_.size(); ++s) form_sensor_rows(block, s);
  form_soft_rows(block.length);
  changes_.form(*model_, evaluator_, is_measured_, state_.base == BaseMode::still);
}

/// W = P Hᵀ and the lower half of S = H W + R.
void ChainFilter::multiply() {
  const FilterLayout& layout = model_->layout;
  const ChainMeasurement& m = evaluator_.result();
  const Index n = layout.size;
  w_.leftCols(rows_).setZero();
  s_.topLeftCorner(rows_, rows_).setZero();
  const auto each_own = [&](std::size_t s, const auto& visit) {  // a sensor's own states: row, state, derivative
    const Index row = sensor_rows * static_cast<Index>(s), own = layout.sensor_state(static_cast<Index>(s));
    for (Index k = 0; k < 3; ++k)
      for (Index j = 0; j < 4; ++j) {
        const bool is_bias = j == 0;
        if (is_measured_[2 * s])
          visit(row + k,
                own + (is_bias ? SensorIndex::gyroscope_bias + k : SensorIndex::gyroscope_scale + 3 * k + j - 1),
                is_bias ? 1.0 : m.angular_velocity[s][j - 1]);
        if (is_measured_[2 * s + 1])
          visit(
              row + 3 + k,
              own + (is_bias ? SensorIndex::accelerometer_bias + k : SensorIndex::accelerometer_scale + 3 * k + j - 1),
              is_bias ? 1.0 : m.force[s][j - 1]);
      }
  };
  for (std::size_t s = 0; s < is_used_.size(); ++s) {
    if (!is_measured_[2 * s] && !is_measured_[2 * s + 1]) continue;
    const Index row = sensor_rows * static_cast<Index>(s), fast = m.fast_end[s], geometry = m.geometry_end[s];
    auto w = w_.middleCols(row, sensor_rows);
    add_product(p_.leftCols(fast), h_.block(row, 0, sensor_rows, fast), 1.0, w);
    if (geometry > 0)
      add_product(p_.middleCols(layout.first_geometry, geometry), m.by_geometry.block(row, 0, sensor_rows, geometry),
                  1.0, w);
    each_own(s, [&](Index at, Index state, double factor) {
      double* to = w_.col(at).data();
      const double* from = p_.col(state).data();
      for (Index i = 0; i < n; ++i) to[i] += factor * from[i];
    });
    for (Index half = 0; half < 2; ++half)
      if (!is_measured_[2 * s + static_cast<std::size_t>(half)]) w_.middleCols(row + 3 * half, 3).setZero();
  }
  for (Index row = layout.rows(); row < rows_; ++row)
    for (Index j = 0; j < layout.fast; ++j)
      if (h_(row, j) > 0.0 || h_(row, j) < 0.0) w_.col(row) += h_(row, j) * p_.col(j);
  for (std::size_t s = 0; s < is_used_.size(); ++s) {
    const Index row = sensor_rows * static_cast<Index>(s), fast = m.fast_end[s], geometry = m.geometry_end[s];
    for (Index j = 0; j <= std::min(row + sensor_rows, rows_) - 1; ++j) {
      auto to = s_.col(j).segment<sensor_rows>(row);
      for (Index k = 0; k < fast; ++k) to += w_(k, j) * h_.col(k).segment<sensor_rows>(row);
      for (Index k = 0; k < geometry; ++k)
        to += w_(layout.first_geometry + k, j) * m.by_geometry.col(k).segment<sensor_rows>(row);
    }
    each_own(s, [&](Index at, Index state, double factor) {
      for (Index j = 0; j <= at; ++j) s_(at, j) += factor * w_(state, j);
    });
    for (Index half = 0; half < 2; ++half)
      if (!is_measured_[2 * s + static_cast<std::size_t>(half)]) s_.middleRows(row + 3 * half, 3).setZero();
  }
  for (Index row = layout.rows(); row < rows_; ++row)
    for (Index k = 0; k < layout.fast; ++k)
      if (h_(row, k) > 0.0 || h_(row, k) < 0.0)
        for (Index j = 0; j <= row; ++j) s_(row, j) += h_(row, k) * w_(k, j);
  for (Index i = 0; i < rows_; ++i) s_(i, i) += noise_[i];
}

/// An instrument that is far off is trusted so much less that it is at the limit.
bool ChainFilter::limit_outliers() {
  bool has_outliers = false;
  for (std::size_t half = 0; half < is_measured_.size(); ++half) {
    if (!is_measured_[half]) continue;
    const Index row = 3 * static_cast<Index>(half);
    Mat3 block = kept_.block<3, 3>(row, row);
    block.triangularView<Eigen::StrictlyUpper>() = block.transpose();
    const Vec3 v = residual_.segment<3>(row);
    const double distance = v.dot(block.inverse() * v);
    if (distance <= outlier_limit) continue;
    has_outliers = true;
    kept_.block<3, 3>(row, row) += (distance / outlier_limit - 1.0) * block;
  }
  return has_outliers;
}

void ChainFilter::judge_as(const ChainFilter& other) {
  is_used_ = other.is_used_;
  for (std::size_t j = 0; j < changes_.size(); ++j)
    if (changes_.is_doubted(j) != other.changes_.is_doubted(j)) changes_.doubt(j, other.changes_.is_doubted(j));
}

/// L⁻¹ and L⁻¹ν, `s_` holding L.
void ChainFilter::invert() {
  auto inverse = inverse_.topLeftCorner(rows_, rows_);
  inverse.setIdentity();
  for (Index j = 0; j < rows_; ++j)  // L⁻¹, column by column
    for (Index k = j; k < rows_; ++k) {
      const double x = inverse_(k, j) / s_(k, k);
      inverse_(k, j) = x;
      for (Index i = k + 1; i < rows_; ++i) inverse_(i, j) -= s_(i, k) * x;
    }
  auto whitened = whitened_.head(rows_);
  whitened.setZero();
  for (Index k = 0; k < rows_; ++k)
    for (Index i = k; i < rows_; ++i) whitened_[i] += inverse_(i, k) * residual_[k];
}

bool ChainFilter::factorise() {
  auto s = s_.topLeftCorner(rows_, rows_);
  s = kept_.topLeftCorner(rows_, rows_);
  if (!factorise_small(s)) return false;
  invert();
  return true;
}

/// Joints in doubt are examined in the S without their changes, which is then widened by them.
bool ChainFilter::allow_joint_changes() {
  if (!changes_.doubts_any()) return true;
  changes_.examine(inverse_.topLeftCorner(rows_, rows_), whitened_.head(rows_), true);
  changes_.widen(kept_.topLeftCorner(rows_, rows_));
  return factorise();
}

/// What a change of each sensor or joint alone would explain.
void ChainFilter::examine_changes() {
  changes_.examine(inverse_.topLeftCorner(rows_, rows_), whitened_.head(rows_), false);
  for (std::size_t j = 0; j < changes_.size(); ++j) innovations_.of_joint[j] = changes_.distance(j);
  examine();
}

/// `weighted`: S⁻¹ν of the sensor's rows, `information` their block of S⁻¹.
void ChainFilter::score_lateness(std::size_t sensor, const SensorVector& weighted, const SensorMatrix& information) {
  const SensorVector by_lateness = -change_.segment<sensor_rows>(sensor_rows * static_cast<Index>(sensor));
  innovations_.lateness[sensor] = {by_lateness.dot(weighted), by_lateness.dot(information * by_lateness)};
}

/// Leave-one-out innovations: with u = S⁻¹ν the innovation of sensor i given all others is [(S⁻¹)_ii]⁻¹u_i, with
/// covariance [(S⁻¹)_ii]⁻¹. `s_` holds L.
void ChainFilter::examine() {
  const auto whitened = whitened_.head(rows_);
  double log_determinant = 0.0;
  for (Index i = 0; i < rows_; ++i) log_determinant += std::log(s_(i, i));
  innovations_.log_likelihood = -0.5 * whitened.squaredNorm() - log_determinant;
  for (std::size_t s = 0; s < is_used_.size(); ++s) {
    const Index row = sensor_rows * static_cast<Index>(s);
    innovations_.rows[s] = (is_measured_[2 * s] ? 3 : 0) + (is_measured_[2 * s + 1] ? 3 : 0);
    if (!is_used_[s]) continue;
    SensorMatrix own;
    SensorVector u;
    for (Index i = 0; i < sensor_rows; ++i) {
      u[i] = inverse_.col(row + i).head(rows_).dot(whitened);
      for (Index j = 0; j <= i; ++j)
        own(i, j) = own(j, i) = inverse_.col(row + i).head(rows_).dot(inverse_.col(row + j).head(rows_));
    }
    for (Index i = 0; i < sensor_rows; ++i)
      if (!is_measured_[2 * s + static_cast<std::size_t>(i / 3)]) u[i] = 0.0;
    innovations_.leave_out[s] = squared_distance(u, own);
    score_lateness(s, u, own);
    for (Index half = 0; half < 2; ++half) {
      const Vec3 v = u.segment<3>(3 * half);
      const Mat3 w = own.block<3, 3>(3 * half, 3 * half);
      leave_out_[2 * s + static_cast<std::size_t>(half)] = v.dot(w.inverse() * v) / 3.0;
    }
  }
}

/// Each instrument's leave-one-out innovation asks for its variance: that of an instrument in motion which the chain
/// does not explain (flexing segments, soft mounts, impacts) grows within a second. The plain innovation does not tell:
/// it is mostly as wide as the accelerations that the state may have.
void ChainFilter::adapt_noise() {
  for (std::size_t half = 0; half < 2; ++half) {
    std::size_t count = 0;
    for (std::size_t i = half; i < is_measured_.size(); i += 2)
      if (is_measured_[i]) ordered_[count++] = leave_out_[i];
    if (count == 0) continue;
    const double middle = lower_median({ordered_.data(), count});
    const double fastest = std::min(outlier_limit / 3.0, lone_inflation * std::max(1.0, middle));
    for (std::size_t i = half; i < is_measured_.size(); i += 2) {
      if (!is_measured_[i]) continue;
      double& factor = half == 0 ? inflation_[i / 2].rate : inflation_[i / 2].force;
      factor =
          std::clamp(factor * std::exp(inflation_gain * (std::min(leave_out_[i], fastest) - 1.0)), 1.0, max_inflation);
    }
  }
  std::size_t used = 0;
  for (std::size_t s = 0; s < is_used_.size(); ++s)
    if (is_used_[s]) ordered_[used++] = std::max(inflation_[s].rate, inflation_[s].force);
  if (used > 0) common_inflation_ = lower_median({ordered_.data(), used});
}

/// The innovation of a sensor that is not used, in its own covariance.
double ChainFilter::distance_of_unused(const BlockMeasurement& block, std::size_t s) {
  const FilterLayout& layout = model_->layout;
  const ChainMeasurement& m = evaluator_.result();
  const SensorSettings& settings = model_->sensors[s];
  const BlockSample& measured = block.sensors[s];
  const Index row = sensor_rows * static_cast<Index>(s), fast = m.fast_end[s], geometry = m.geometry_end[s];
  unused_w_.setZero();
  add_product(p_.leftCols(fast), m.by_fast.block(row, 0, sensor_rows, fast), 1.0, unused_w_);
  if (geometry > 0)
    add_product(p_.middleCols(layout.first_geometry, geometry), m.by_geometry.block(row, 0, sensor_rows, geometry), 1.0,
                unused_w_);
  // Its own errors are taken as uncorrelated with the rest: they are of no use while it is out of use.
  const Index own = layout.sensor_state(static_cast<Index>(s));
  SensorMatrix covariance = SensorMatrix::Zero();
  for (Index k = 0; k < fast; ++k) covariance += m.by_fast.col(k).segment<sensor_rows>(row) * unused_w_.row(k);
  for (Index k = 0; k < geometry; ++k)
    covariance += m.by_geometry.col(k).segment<sensor_rows>(row) * unused_w_.row(layout.first_geometry + k);
  const double rate = block_variance(settings.white.rate, settings.persistent.rate, settings.slow.rate,
                                     settings.sample_period, block.length, measured.rate_count),
               force = block_variance(settings.white.force, settings.persistent.force, settings.slow.force,
                                      settings.sample_period, block.length, measured.force_count);
  for (Index i = 0; i < sensor_rows; ++i)
    covariance(i, i) += common_inflation_ * (i < 3 ? rate : force) + p_(own + i, own + i) +
                        p_.diagonal()
                            .segment<3>(own + SensorIndex::gyroscope_scale + 3 * i)
                            .dot((i < 3 ? m.angular_velocity[s] : m.force[s]).cwiseAbs2());
  const SensorVector innovation = innovations_.value.segment<sensor_rows>(row),
                     by_lateness = -change_.segment<sensor_rows>(row);
  const auto distance = [&](const SensorVector& v) { return squared_distance(v, covariance); };
  innovations_.lateness[s] = {0.25 * (distance(by_lateness + innovation) - distance(by_lateness - innovation)),
                              distance(by_lateness)};
  return distance(innovation);
}

void ChainFilter::correct() {
  const Index estimated = model_->layout.first_geometry, n = model_->layout.size, geometry = n - estimated;
  auto y = w_.leftCols(rows_);
  solve_right(s_.topLeftCorner(rows_, rows_), y);
  error_.setZero();
  for (Index j = 0; j < rows_; ++j) error_.head(estimated) += whitened_[j] * w_.col(j).head(estimated);
  retract(*model_, error_, state_);
  add_square(w_.block(0, 0, estimated, rows_), -1.0, p_.topLeftCorner(estimated, estimated));
  if (geometry > 0)
    add_product(w_.block(estimated, 0, geometry, rows_), w_.block(0, 0, estimated, rows_), -1.0,
                p_.block(estimated, 0, geometry, estimated));
  bound();
  mirror();
}

/// Nothing is known less than this: a variance that grows without limit would leave the range of the linearisation.
void ChainFilter::bound() {
  const FilterLayout& layout = model_->layout;
  for (Index i = 0; i < layout.fast; ++i) {
    const bool is_position = i < 3 || (i >= base_states && (i - base_states) % position_states == 0);
    const double limit = is_position ? max_position_sd : max_motion_sd;
    if (p_(i, i) <= limit * limit) continue;
    const double factor = limit / std::sqrt(p_(i, i));
    for (Index j = 0; j <= i; ++j) p_(i, j) *= factor;
    for (Index j = i; j < layout.size; ++j) p_(j, i) *= factor;
  }
}

/// The lower half becomes the upper one, in tiles that stay in the cache.
void ChainFilter::mirror() {
  constexpr Index tile = 16;
  const Index n = p_.rows();
  double* p = p_.data();
  for (Index j0 = 0; j0 < n; j0 += tile)
    for (Index i0 = j0; i0 < n; i0 += tile)
      for (Index j = j0; j < std::min(j0 + tile, n); ++j)
        for (Index i = std::max(i0, j + 1); i < std::min(i0 + tile, n); ++i) p[i * n + j] = p[j * n + i];
}

void ChainFilter::update(const BlockMeasurement& block) {
  KINFER_EXPECT(block.sensors.size() == is_used_.size());
  form_rows(block);
  multiply();
  kept_.topLeftCorner(rows_, rows_) = s_.topLeftCorner(rows_, rows_);
  if (!factorise() || !allow_joint_changes()) return;
  examine_changes();
  innovations_.unlimited = innovations_.leave_out;
  innovations_.unlimited_of_joint = innovations_.of_joint;
  if (limit_outliers()) {
    if (!factorise()) return;
    examine_changes();
  }
  adapt_noise();
  for (std::size_t s = 0; s < is_used_.size(); ++s) {
    if (is_used_[s]) continue;
    const bool is_measured = block.sensors[s].rate_count > 0 && block.sensors[s].force_count > 0;
    innovations_.rows[s] = is_measured ? static_cast<int>(sensor_rows) : 0;
    if (is_measured) innovations_.leave_out[s] = innovations_.unlimited[s] = distance_of_unused(block, s);
  }
  correct();
}

double ChainFilter::variance(const ScalarRow& row) const {
  double variance = row.variance;
  for (std::size_t i = 0; i < static_cast<std::size_t>(row.terms); ++i)
    for (std::size_t k = 0; k < static_cast<std::size_t>(row.terms); ++k)
      variance += row.factor[i] * row.factor[k] * p_(row.at[i], row.at[k]);
  return variance;
}

void ChainFilter::update(const ScalarRow& row) {
  const Index estimated = model_->layout.first_geometry;
  const double variance = this->variance(row);
  auto w = w_.col(0);
  w.setZero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(row.terms); ++i) w += row.factor[i] * p_.col(row.at[i]);
  if (row.noisy_state >= 0) w[row.noisy_state] += row.noise_covariance;
  error_.setZero();
  error_.head(estimated) = (row.innovation / variance) * w.head(estimated);
  retract(*model_, error_, state_);
  for (Index j = 0; j < estimated; ++j)
    for (Index i = j; i < p_.rows(); ++i) p_(i, j) -= w[i] * w[j] / variance;
  mirror();
}

}  // namespace kinfer::track
