#include "kinfer/inertial/kinfer_offline.hpp"

#include <algorithm>

#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

constexpr int states = kinfer_states, offline_constants = 12, first_constant = 5;
constexpr int packed_size = states * (states + 1) / 2;

/// One update period of the forward pass.
struct Step {
  std::size_t first_row = 0, last_row = 0;  // its rows: (first, last]
  KinferBelief begin, predicted;            // at its begin, after the correction there; at its end, before correction
  std::array<double, packed_size> covariance{};  // of `predicted`, lower half
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

/// Where the forward pass can be taken up again: memory for a few periods is enough for any length of recording.
struct Resumption {
  KinferFilter filter;
  Step step;            // that has begun
  std::size_t row = 0;  // read next
};

struct ForwardPass {
  std::vector<Step> steps;
  std::size_t first_row = 0;  // of `turned`
  std::vector<Quat> turned;   // each row's orientation relative to the begin of its step
  Resumption end;
};

constexpr std::size_t steps_at_a_time = 256;

/// On from there, for some steps or to the last row.
ForwardPass forward_pass(const InsSensor& sensor, std::span<const double> time, const Resumption& from) {
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
      step.begin = filter.belief();
    }
    pass.turned.back() = step.begin.world_q_sensor.conjugate() * filter.orientation();
    if (!filter.update_is_due()) continue;
    step.last_row = here;
    step.transition = filter.predict();
    step.predicted = filter.belief();
    step.covariance = packed(filter.covariance());
    pass.steps.push_back(step);
    filter.correct();
    step.first_row = here;
    step.begin = filter.belief();
  }
  return pass;
}

/// Belief at the step's begin, given the best one at its end: x + F⁻¹ (1 - Q P⁻¹) (x' - F x), which is
/// Rauch-Tung-Striebel's gain P Fᵀ P'⁻¹ with P' = F P Fᵀ + Q.
KinferBelief smoothed_begin(const Step& step, const KinferBelief& end) {
  const KinferVector error = difference(end, step.predicted);
  const auto weighted = solve_positive(unpacked(step.covariance), error);
  KinferVector e = error;
  if (weighted) e -= step.transition.noise.cwiseProduct(*weighted);
  const Vec3 rotation = e.head<3>() - step.transition.by_constants * e.segment<offline_constants>(first_constant);
  e.head<3>() = rotation;
  e[3] -= step.transition.lift * rotation.y();
  e[4] += step.transition.lift * rotation.x();
  return corrected(step.begin, e);
}

/// Orientations of the step's rows between its two smoothed ends: the forward pass's turning, with what does not close
/// spread evenly over time.
void fill_rows(const Step& step, const Quat& begin, const Quat& end, std::span<const double> time,
               const ForwardPass& pass, std::vector<Quat>& out) {
  const auto turned = [&](std::size_t row) { return pass.turned[row - pass.first_row]; };
  const Vec3 open = quat_log(end * (begin * turned(step.last_row)).conjugate());
  const double span = time[step.last_row] - time[step.first_row];
  for (std::size_t row = step.first_row + 1; row <= step.last_row; ++row) {
    const double share = (time[row] - time[step.first_row]) / span;
    out[row] = (quat_exp(share * open) * begin * turned(row)).normalized();
  }
}

/// Where the forward pass may be taken up, in order; the last one is its end.
std::vector<Resumption> resumptions(const InsSensor& sensor, std::span<const double> time,
                                    const KinferFilterOptions& options, SmoothedMotion& motion) {
  std::vector<Resumption> all{{.filter = KinferFilter(options), .step = {}, .row = 0}};
  do {
    const ForwardPass pass = forward_pass(sensor, time, all.back());
    for (const Step& step : pass.steps) motion.update_time.push_back(time[step.last_row]);
    all.push_back(pass.end);
  } while (all.back().row < time.size());
  return all;
}

}  // namespace

SmoothedMotion smoothed_motion(const InsSensor& sensor, std::span<const double> time,
                               const KinferOfflineOptions& options) {
  SmoothedMotion motion;
  const std::vector<Resumption> from = resumptions(sensor, time, options.filter, motion);
  motion.world_q_sensor.assign(time.size(), Quat::Identity());
  motion.bias.resize(motion.update_time.size());
  const Step& open = from.back().step;  // its period never came to an end: its rows hang on its begin
  KinferBelief end = open.begin;
  std::size_t update = motion.bias.size(), first_row = open.first_row;
  for (std::size_t k = from.size() - 1; k-- > 0;) {
    const ForwardPass pass = forward_pass(sensor, time, from[k]);
    for (std::size_t row = std::max(open.first_row, pass.first_row); row < pass.end.row; ++row)
      motion.world_q_sensor[row] = (open.begin.world_q_sensor * pass.turned[row - pass.first_row]).normalized();
    for (std::size_t i = pass.steps.size(); i-- > 0;) {
      const KinferBelief begin = smoothed_begin(pass.steps[i], end);
      fill_rows(pass.steps[i], begin.world_q_sensor, end.world_q_sensor, time, pass, motion.world_q_sensor);
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
