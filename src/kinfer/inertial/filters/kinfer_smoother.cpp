// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/filters/kinfer_smoother.hpp"

#include <algorithm>

#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

constexpr int states = kinfer_states, gyro_error_size = 12, first_gyro_error = 5;
constexpr double bias_sd_by_rest = 2e-3;  // [rad/s] what a consumer gyroscope drifts by within minutes
constexpr double known_bias_sd = 3e-3;    // [rad/s] of one that a rest told some minutes ago
// Moments of stillness, without their margins: those that count, the longest of them, and how near their rates are.
// Slow rotations of 28 simulated machines that never rest have rates that differ by 0.007 to 0.04 rad/s, or a single
// moment of 0.2 s; a chain in hands that is held still once (DIODEM) has one of 0.45 to 0.65 s.
constexpr double least_moment = 0.1, least_longest_moment = 0.3, agreeing_rates = 5e-3;  // [s], [s], [rad/s]
constexpr int packed_size = states * (states + 1) / 2;

/// One update period of the forward pass.
struct SmootherStep {
  std::size_t first_row = 0, last_row = 0;       // its rows: (first, last]
  KinferEstimate begin, predicted;               // at its begin, after correction; at its end, before correction
  std::array<double, packed_size> covariance{};  // of `predicted`, lower triangle
  KinferTransition transition;
};

std::array<double, packed_size> packed(const KinferCovariance& full) {
  std::array<double, packed_size> half{};
  std::size_t k = 0;
  for (int i = 0; i < states; ++i)
    for (int j = 0; j <= i; ++j) half[k++] = full(i, j);
  return half;
}

MatrixXd unpacked(const std::array<double, packed_size>& half) {
  MatrixXd full(states, states);
  std::size_t k = 0;
  for (int i = 0; i < states; ++i)
    for (int j = 0; j <= i; ++j) full(i, j) = full(j, i) = half[k++];
  return full;
}

/// Checkpoint from which the forward pass can be resumed, so that memory does not hold every period of a long
/// recording.
struct Checkpoint {
  KinferFilter filter;
  SmootherStep step;    // in progress
  std::size_t row = 0;  // next to be read
};

struct ForwardPass {
  std::vector<SmootherStep> steps;
  std::size_t first_row = 0;  // of `turned`
  std::vector<Quat> turned;   // each row's orientation relative to the start of its step
  Checkpoint end;
};

constexpr std::size_t steps_at_a_time = 256;

/// Continues from a checkpoint for up to steps_at_a_time steps or to the last row.
ForwardPass run_forward_pass(const InsSensor& sensor, std::span<const double> time, const Checkpoint& from) {
  ForwardPass pass{.steps = {}, .first_row = from.row, .turned = {}, .end = from};
  auto& [filter, step, row] = pass.end;
  while (row < time.size() && pass.steps.size() < steps_at_a_time) {
    const bool was_started = filter.started();
    filter.integrate(sample(sensor, time, row));
    pass.turned.push_back(Quat::Identity());
    const std::size_t here = row++;
    if (!filter.started()) continue;
    if (!was_started) {
      step.first_row = here;
      step.begin = filter.estimate();
    }
    pass.turned.back() = step.begin.world_q_sensor.conjugate() * filter.orientation();
    if (!filter.update_is_due()) continue;
    step.last_row = here;
    step.transition = filter.predict();
    step.predicted = filter.estimate();
    step.covariance = packed(filter.covariance());
    pass.steps.push_back(step);
    filter.correct();
    step.first_row = here;
    step.begin = filter.estimate();
  }
  return pass;
}

/// Smoothed estimate at the start of a step, given the one at its end: x + F⁻¹ (1 - Q P'⁻¹) (x' - F x), which is the
/// Rauch-Tung-Striebel gain P Fᵀ P'⁻¹ with P' = F P Fᵀ + Q.
KinferEstimate smooth_step_start(const SmootherStep& step, const KinferEstimate& end) {
  const KinferErrorState error = difference(end, step.predicted);
  const auto weighted = solve_spd(unpacked(step.covariance), error);
  KinferErrorState e = error;
  if (weighted) e -= step.transition.noise.cwiseProduct(*weighted);
  const Vec3 rotation =
      e.head<3>() - step.transition.rotation_by_gyro_errors * e.segment<gyro_error_size>(first_gyro_error);
  e.head<3>() = rotation;
  e[3] -= step.transition.velocity_by_tilt * rotation.y();
  e[4] += step.transition.velocity_by_tilt * rotation.x();
  return corrected(step.begin, e);
}

/// Orientations of the step's rows between its two smoothed ends: the rotation of the forward pass, with the misclosure
/// distributed evenly over time.
void interpolate_rows(const SmootherStep& step, const Quat& begin, const Quat& end, std::span<const double> time,
                      const ForwardPass& pass, std::vector<Quat>& out) {
  const auto turned = [&](std::size_t row) { return pass.turned[row - pass.first_row]; };
  const Vec3 open = quat_log(end * (begin * turned(step.last_row)).conjugate());
  const double span = time[step.last_row] - time[step.first_row];
  for (std::size_t row = step.first_row + 1; row <= step.last_row; ++row) {
    const double share = (time[row] - time[step.first_row]) / span;
    out[row] = (quat_exp(share * open) * begin * turned(row)).normalized();
  }
}

/// Checkpoints of the forward pass, in order; the last one is its end.
std::vector<Checkpoint> forward_checkpoints(const InsSensor& sensor, std::span<const double> time,
                                            const KinferFilterOptions& options, FilterOutput& motion) {
  std::vector<Checkpoint> all{{.filter = KinferFilter(options), .step = {}, .row = 0}};
  do {
    const ForwardPass pass = run_forward_pass(sensor, time, all.back());
    for (const SmootherStep& step : pass.steps) motion.bias_time.push_back(time[step.last_row]);
    all.push_back(pass.end);
  } while (all.back().row < time.size());
  return all;
}

/// Whether moments of stillness tell the bias of a recording without rests: one bias is the same in all of them.
bool moments_tell_bias(const RestOptions& options, const InsSensor& sensor, std::span<const double> time) {
  RestOptions moments = options;
  moments.listed = least_moment;
  const std::vector<RestPeriod> still = rest_periods(sensor, time, moments);
  if (still.empty()) return false;
  const RestPeriod& longest = *std::ranges::max_element(still, {}, &RestPeriod::seconds);
  return longest.seconds() > least_longest_moment && std::ranges::all_of(still, [&](const RestPeriod& moment) {
           return (moment.angular_velocity - longest.angular_velocity).norm() < agreeing_rates;
         });
}

/// A recording that begins in motion begins with the bias of its longest rest. Before a rest has told the bias, any
/// moment of a slow rotation would pass for one: without rests, gravity alone tells it, unless moments agree.
KinferFilterOptions started_by_rest(KinferFilterOptions options, const InsSensor& sensor,
                                    std::span<const double> time) {
  const std::vector<RestPeriod> rests = rest_periods(sensor, time);
  if (!rests.empty() || !moments_tell_bias(options.rest, sensor, time)) options.moment_bias_sd = known_bias_sd;
  if (rests.empty() || rests.front().begin < time.front() + options.rest.mean_time) return options;
  options.bias = std::ranges::max_element(rests, {}, &RestPeriod::seconds)->angular_velocity;
  options.bias_sd = bias_sd_by_rest;
  return options;
}

}  // namespace

FilterOutput smooth_orientation(const InsSensor& sensor, std::span<const double> time,
                                const KinferOfflineOptions& options) {
  FilterOutput motion;
  const std::vector<Checkpoint> from =
      forward_checkpoints(sensor, time, started_by_rest(options.filter, sensor, time), motion);
  motion.world_q_sensor.assign(time.size(), Quat::Identity());
  motion.bias.resize(motion.bias_time.size());
  const SmootherStep& open = from.back().step;  // incomplete period: its rows are relative to its start
  KinferEstimate end = open.begin;
  std::size_t update = motion.bias.size(), first_row = open.first_row;
  for (std::size_t k = from.size() - 1; k-- > 0;) {
    const ForwardPass pass = run_forward_pass(sensor, time, from[k]);
    for (std::size_t row = std::max(open.first_row, pass.first_row); row < pass.end.row; ++row)
      motion.world_q_sensor[row] = (open.begin.world_q_sensor * pass.turned[row - pass.first_row]).normalized();
    for (std::size_t i = pass.steps.size(); i-- > 0;) {
      const KinferEstimate begin = smooth_step_start(pass.steps[i], end);
      interpolate_rows(pass.steps[i], begin.world_q_sensor, end.world_q_sensor, time, pass, motion.world_q_sensor);
      motion.bias[--update] = end.bias;
      end = begin;
      first_row = pass.steps[i].first_row;
    }
  }
  motion.scale = end.scale;
  for (std::size_t row = 0; row <= first_row && row < time.size(); ++row)
    motion.world_q_sensor[row] = end.world_q_sensor.normalized();
  return motion;
}

}  // namespace kinfer
