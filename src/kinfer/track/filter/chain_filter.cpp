// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/filter/chain_filter.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/square.hpp"
#include "kinfer/track/model/thresholds.hpp"

namespace kinfer::track {
namespace {

/// Variance of a block's mean: white noise averages out, what persists over the block does not, and what persists over
/// many blocks is worth more white noise than either.
double block_variance(double white, double persistent, double slow, double sample_period, double length, int count) {
  return std::max(square(white) / count + square(persistent), square(slow) * sample_period / length);
}

}  // namespace

ChainFilter::ChainFilter(std::shared_ptr<const FilterModel> model)
    : model_(std::move(model)),
      state_(initial_state(*model_)),
      evaluator_(*model_),
      soft_rows_(*model_),
      changes_(*model_),
      levels_(model_->sensors.size()),
      headings_(*model_),
      limb_turns_(*model_),
      constant_faults_(*model_),
      mean_rates_(*model_),
      innovations_(*model_),
      system_(*model_) {
  const FilterLayout& layout = model_->layout;
  p_ = MatrixXd::Zero(layout.size, layout.size);
  p_.bottomRightCorner(layout.size - layout.fast, layout.size - layout.fast) = model_->parameters;
  is_used_.assign(static_cast<std::size_t>(layout.sensors), true);
  last_value_ = change_ = change_of_change_ = VectorXd::Zero(layout.rows());
  error_ = column_ = VectorXd::Zero(layout.size);
  unused_w_ = MatrixXd::Zero(layout.size, sensor_rows);
  bias_variance_ = VectorXd::Zero(layout.rows());
  for (Index s = 0; s < layout.sensors; ++s) {
    auto own = bias_variance_.segment<sensor_rows>(sensor_rows * s);
    own = p_.diagonal().segment<sensor_rows>(layout.sensor_state(s));
    own.head<3>().array() += square(model_->bias.rate), own.tail<3>().array() += square(model_->bias.force);
  }
}

void ChainFilter::predict(double time) {
  while (time - state_.time > 1e-9) {
    const double dt = std::min(time - state_.time, longest_step);
    predict_covariance(*model_, state_, dt, p_, shown_);
    add_posture_walk(dt);
    constant_faults_.predict(*model_, state_, dt, shown_);
    predict_mean(*model_, dt, state_, shown_);
  }
}

/// Axes that are off by an angle that is considered, and not estimated, show as an acceleration that changes with the
/// posture. To a bias that was found in another posture it is a random walk with the angle turned through.
void ChainFilter::add_posture_walk(double dt) {
  const std::vector<Vec3>& rates = evaluator_.result().angular_velocity;
  for (std::size_t s = 0; s < model_->sensors.size(); ++s) {
    const double per_turn = posture_walk * square(model_->gravity * model_->sensors[s].axis_sd);
    const Index bias = model_->layout.sensor_state(static_cast<Index>(s)) + SensorIndex::accelerometer_bias;
    const double walk = dt * rates[s].norm() * per_turn;
    const Index own = sensor_rows * static_cast<Index>(s);
    p_.diagonal().segment<3>(bias).array() += walk;
    bias_variance_.segment<3>(own + 3).array() += walk;
  }
  widen_bias_distance(dt);
}

InsLevel ChainFilter::bias_distance(std::size_t s) const {
  const Index own = sensor_rows * static_cast<Index>(s);
  const Vec3 rate = state_.sensors[s].gyroscope_bias - model_->sensors[s].gyroscope_bias,
             force = state_.sensors[s].accelerometer_bias - model_->sensors[s].accelerometer_bias;
  return {rate.cwiseAbs2().cwiseQuotient(bias_variance_.segment<3>(own)).sum(),
          force.cwiseAbs2().cwiseQuotient(bias_variance_.segment<3>(own + 3)).sum()};
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

/// [s]; 0: there was none.
double ChainFilter::time_since_update() const {
  return last_update_ ? state_.time - *last_update_ : 0.0;
}

/// Of the predicted rows; none after a gap.
void ChainFilter::follow_change() {
  const double dt = time_since_update();
  const VectorXd& value = evaluator_.result().value;
  change_of_change_ = change_;
  if (dt > 0.0 && dt <= longest_step)
    change_ = (value - last_value_) / dt;
  else
    change_.setZero();
  change_of_change_ = change_ - change_of_change_;
  last_value_ = value;
  last_update_ = state_.time;
}

void ChainFilter::form_sensor_rows(const BlockMeasurement& block, std::size_t s) {
  const BlockSample& measured = block.sensors[s];
  const SensorSettings& settings = model_->sensors[s];
  const Index row = sensor_rows * static_cast<Index>(s);
  const auto set = [&](Index first, int count, double time, const Vec3& value, double white, double persistent,
                       double slow, double factor) {
    innovations_.value.segment<3>(first) =
        value - evaluator_.result().value.segment<3>(first) - time * change_.segment<3>(first);
    innovations_.value.segment<3>(first) +=
        evaluator_.result().by_fast.middleRows<3>(first) * error_.head(model_->layout.fast);
    // Samples at another time than the block's are as uncertain as the rows' rate of change, which changes as well.
    const double shifted = square(time) * change_of_change_.segment<3>(first).squaredNorm();
    system_.set_instrument(
        first, is_used_[s] && count > 0, innovations_.value.segment<3>(first),
        factor * block_variance(white, persistent, slow, settings.sample_period, block.length, count) + shifted +
            limb_turns_.variance()[first]);
  };
  set(row, measured.rate_count, measured.rate_time, measured.rate, settings.white.rate, settings.persistent.rate,
      settings.slow.rate, levels_.of(s).rate);
  set(row + 3, measured.force_count, measured.force_time, measured.force, settings.white.force,
      settings.persistent.force, settings.slow.force, levels_.of(s).force);
}

void ChainFilter::form_rows(const BlockMeasurement& block) {
  evaluator_.evaluate(*model_, state_);
  follow_change();
  system_.begin(evaluator_.result());
  error_.setZero();
  shown_ = ShownMeans::rates;
  limb_turns_.update(*model_, state_, p_);
  for (std::size_t s = 0; s < is_used_.size(); ++s) {
    form_sensor_rows(block, s);
    if (!is_used_[s] || block.sensors[s].rate_count == 0) shown_ = ShownMeans::accelerations;
  }
  soft_rows_.add(*model_, state_, p_, block.length, system_);
  changes_.form(*model_, evaluator_, system_.is_measured(), state_.base == BaseMode::still);
}

/// After a gap a joint may be far from where it was predicted: the sensors' rows are linearised again where the update
/// leads, until it leads nowhere else (iterated EKF; Bell and Cathey 1993).
void ChainFilter::relinearise(const BlockMeasurement& block) {
  const Index fast = model_->layout.fast;
  predicted_ = state_;
  for (int round = 0; round < relinearisations; ++round) {
    system_.multiply(evaluator_.result(), p_);
    if (!system_.factorise()) break;
    if (system_.limit_outliers() && !system_.factorise()) break;
    system_.divide();
    column_ = error_;
    error_.setZero();
    for (Index j = 0; j < system_.rows(); ++j)
      error_.head(fast) += system_.whitened()[j] * system_.gain().col(j).head(fast);
    const double moved = (error_ - column_).lpNorm<Eigen::Infinity>();
    state_ = predicted_;
    retract(*model_, error_, state_);
    evaluator_.evaluate(*model_, state_);
    system_.linearise_again(evaluator_.result());
    for (std::size_t s = 0; s < is_used_.size(); ++s) form_sensor_rows(block, s);
    if (moved < linearised) break;
  }
  changes_.form(*model_, evaluator_, system_.is_measured(), state_.base == BaseMode::still);
  state_ = predicted_;
}

void ChainFilter::judge_as(const ChainFilter& other) {
  is_used_ = other.is_used_;
  for (std::size_t j = 0; j < changes_.size(); ++j)
    if (changes_.is_doubted(j) != other.changes_.is_doubted(j)) changes_.doubt(j, other.changes_.is_doubted(j));
}

/// Joints in doubt are examined in the S without their changes, which is then widened by them.
bool ChainFilter::allow_joint_changes() {
  if (!changes_.doubts_any()) return true;
  changes_.examine(system_.inverse(), system_.whitened(), true);
  changes_.widen(system_.covariance());
  return system_.factorise();
}

/// What a change of each sensor or joint alone would explain.
void ChainFilter::examine_changes() {
  changes_.examine(system_.inverse(), system_.whitened(), false);
  for (std::size_t j = 0; j < changes_.size(); ++j) innovations_.of_joint[j] = changes_.distance(j);
  examine_sensors(system_, is_used_, evaluator_.result(), change_, innovations_);
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
    add_product(p_.middleCols(layout.first_unseen, geometry), m.by_geometry.block(row, 0, sensor_rows, geometry), 1.0,
                unused_w_);
  // Its own errors are taken as uncorrelated with the rest: they are of no use while it is out of use.
  const Index own = layout.sensor_state(static_cast<Index>(s));
  SensorMatrix covariance = SensorMatrix::Zero();
  for (Index k = 0; k < fast; ++k) covariance += m.by_fast.col(k).segment<sensor_rows>(row) * unused_w_.row(k);
  for (Index k = 0; k < geometry; ++k)
    covariance += m.by_geometry.col(k).segment<sensor_rows>(row) * unused_w_.row(layout.first_unseen + k);
  const double rate = block_variance(settings.white.rate, settings.persistent.rate, settings.slow.rate,
                                     settings.sample_period, block.length, measured.rate_count),
               force = block_variance(settings.white.force, settings.persistent.force, settings.slow.force,
                                      settings.sample_period, block.length, measured.force_count);
  for (Index i = 0; i < sensor_rows; ++i)
    covariance(i, i) += limb_turns_.variance()[row + i] + levels_.common() * (i < 3 ? rate : force) +
                        p_(own + i, own + i) +
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

void ChainFilter::examine_unused(const BlockMeasurement& block) {
  for (std::size_t s = 0; s < is_used_.size(); ++s) {
    if (is_used_[s]) continue;
    const bool is_measured = block.sensors[s].rate_count > 0 && block.sensors[s].force_count > 0;
    innovations_.rows[s] = is_measured ? static_cast<int>(sensor_rows) : 0;
    if (is_measured) innovations_.leave_out[s] = innovations_.unlimited[s] = distance_of_unused(block, s);
  }
}

void ChainFilter::correct(double length) {
  const Index estimated = this->estimated(), n = model_->layout.size, geometry = n - estimated;
  system_.divide();
  const auto gain = system_.gain();
  headings_.begin_update(*model_, state_, p_);
  error_.setZero();
  for (Index j = 0; j < system_.rows(); ++j)
    error_.head(estimated) += system_.whitened()[j] * gain.col(j).head(estimated);
  headings_.limit_correction(error_);
  retract(*model_, error_, state_);
  add_square(gain.topRows(estimated), -1.0, p_.topLeftCorner(estimated, estimated));
  if (geometry > 0)
    add_product(gain.bottomRows(geometry), gain.topRows(estimated), -1.0, p_.block(estimated, 0, geometry, estimated));
  headings_.end_update(gain, error_, state_.time, p_);
  constant_faults_.update(system_, evaluator_.result(), change_, length, estimated);
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

/// Where the rates of all joints are seen without a gap: elsewhere positions do not follow from their means.
void ChainFilter::add_what_means_miss(double dt, const BlockMeasurement& block) {
  if (shown_ != ShownMeans::rates || !(dt > 0.0) || dt > longest_bridge) return mean_rates_.reset();
  const auto rows = [](const BlockSample& sample) { return sample.rate_count; };
  error_.setZero();
  mean_rates_.add_missed(*model_, state_, dt, std::ranges::max(block.sensors, {}, rows).rate_count, error_);
  retract(*model_, error_, state_);
}

double ChainFilter::run(std::span<const BlockMeasurement> rows) {
  double log_likelihood = 0.0;
  for (const BlockMeasurement& block : rows) {
    predict(block.time);
    update(block);
    log_likelihood += innovations_.log_likelihood;
  }
  return log_likelihood;
}

void ChainFilter::update(const BlockMeasurement& block) {
  KINFER_EXPECT(block.sensors.size() == is_used_.size());
  const double dt = time_since_update();
  form_rows(block);
  if (dt > longest_bridge) relinearise(block);
  system_.multiply(evaluator_.result(), p_);
  if (!system_.factorise() || !allow_joint_changes()) return;
  examine_changes();
  innovations_.unlimited = innovations_.leave_out;
  innovations_.unlimited_of_joint = innovations_.of_joint;
  if (system_.limit_outliers()) {
    if (!system_.factorise()) return;
    examine_changes();
  }
  levels_.adapt(innovations_, system_.is_measured(), is_used_);
  examine_unused(block);
  correct(block.length);
  add_what_means_miss(dt, block);
}

/// With the filter's error s θ and the mounting J θ, which is now part of the state, the error is (s − J) θ. It is
/// independent of the error that a filter without the turn would have (Friedland 1969).
void ChainFilter::believe_turn(std::size_t sensor, const Vec3& mean, const Mat3& covariance, double excess) {
  const Index estimated = this->estimated(),
              scales = model_->layout.sensor_state(static_cast<Index>(sensor)) + SensorIndex::gyroscope_scale;
  MatrixXd off = constant_faults_.by_fault().middleRows<3>(3 * static_cast<Index>(sensor)).transpose();
  off.bottomRows(off.rows() - estimated).setZero();
  off.middleRows<18>(scales) -= scales_by_turn();
  error_.setZero();
  error_.head(off.rows()) = -off * mean;
  retract(*model_, error_, state_);
  p_.topLeftCorner(off.rows(), off.rows()) += off * covariance * off.transpose();
  constant_faults_.believe_turn(sensor, off, covariance, excess);
}

double ChainFilter::variance(const ScalarRow& row) const {
  double variance = row.variance;
  for (std::size_t i = 0; i < static_cast<std::size_t>(row.terms); ++i)
    for (std::size_t k = 0; k < static_cast<std::size_t>(row.terms); ++k)
      variance += row.factor[i] * row.factor[k] * p_(row.at[i], row.at[k]);
  return variance;
}

/// Covariance of the row's noise with its noisy state. Noise reaches the state with a delay where accelerometers smooth
/// it: the state shares no more of it than its variance holds.
double ChainFilter::shared_noise(const ScalarRow& row) const {
  const double most = most_shared_noise * std::sqrt(row.variance * p_(row.noisy_state, row.noisy_state));
  return std::clamp(row.noise_covariance, -most, most);
}

void ChainFilter::update(const ScalarRow& row) {
  const Index estimated = this->estimated();
  const double variance = this->variance(row);
  VectorXd& w = column_;
  w.setZero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(row.terms); ++i) w += row.factor[i] * p_.col(row.at[i]);
  if (row.noisy_state >= 0) w[row.noisy_state] += shared_noise(row);
  error_.setZero();
  error_.head(estimated) = (row.innovation / variance) * w.head(estimated);
  retract(*model_, error_, state_);
  for (Index j = 0; j < estimated; ++j)
    for (Index i = j; i < p_.rows(); ++i) p_(i, j) -= w[i] * w[j] / variance;
  constant_faults_.update(row.at, row.factor, row.terms, w, variance, estimated);
  mirror();
}

}  // namespace kinfer::track
