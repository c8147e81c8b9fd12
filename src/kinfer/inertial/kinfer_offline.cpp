#include "kinfer/inertial/kinfer_offline.hpp"

#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

constexpr int states = kinfer_states, constants = 12, first_constant = 5;
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

struct ForwardPass {
  std::vector<Step> steps;
  std::vector<Quat> turned;                 // each row's orientation relative to the begin of its step
  KinferBelief last;                        // after the last correction
  std::size_t first_row = 0, last_row = 0;  // where the filter starts; where the last step ends
};

/// Rows after the last whole period hang on its end, rows before the start on its begin.
ForwardPass forward_pass(const InsSensor& sensor, std::span<const double> time, const KinferFilterOptions& options) {
  ForwardPass pass;
  pass.turned.assign(time.size(), Quat::Identity());
  KinferFilter filter(options);
  Step step;
  for (std::size_t row = 0; row < time.size(); ++row) {
    const bool was_started = filter.started();
    filter.integrate(sample(sensor, time, row));
    if (!filter.started()) continue;
    if (!was_started) {
      pass.first_row = step.first_row = row;
      step.begin = filter.belief();
    }
    pass.turned[row] = step.begin.world_q_sensor.conjugate() * filter.orientation();
    if (!filter.update_is_due()) continue;
    step.last_row = row;
    step.transition = filter.predict();
    step.predicted = filter.belief();
    step.covariance = packed(filter.covariance());
    pass.steps.push_back(step);
    filter.correct();
    step.first_row = row;
    step.begin = filter.belief();
  }
  pass.last = step.begin;
  pass.last_row = step.first_row;
  return pass;
}

/// Belief at the step's begin, given the best one at its end: x + F⁻¹ (1 - Q P⁻¹) (x' - F x), which is
/// Rauch-Tung-Striebel's gain P Fᵀ P'⁻¹ with P' = F P Fᵀ + Q.
KinferBelief smoothed_begin(const Step& step, const KinferBelief& end) {
  const KinferVector error = difference(end, step.predicted);
  const auto weighted = solve_positive(unpacked(step.covariance), error);
  KinferVector e = error;
  if (weighted) e -= step.transition.noise.cwiseProduct(*weighted);
  const Vec3 rotation = e.head<3>() - step.transition.by_constants * e.segment<constants>(first_constant);
  e.head<3>() = rotation;
  e[3] -= step.transition.lift * rotation.y();
  e[4] += step.transition.lift * rotation.x();
  return corrected(step.begin, e);
}

/// Orientations of the step's rows between its two smoothed ends: the forward pass's turning, with what does not close
/// spread evenly over time.
void fill_rows(const Step& step, const Quat& begin, const Quat& end, std::span<const double> time,
               const std::vector<Quat>& turned, std::vector<Quat>& out) {
  const Vec3 open = quat_log(end * (begin * turned[step.last_row]).conjugate());
  const double span = time[step.last_row] - time[step.first_row];
  for (std::size_t row = step.first_row + 1; row <= step.last_row; ++row) {
    const double share = (time[row] - time[step.first_row]) / span;
    out[row] = (quat_exp(share * open) * begin * turned[row]).normalized();
  }
}

}  // namespace

SmoothedMotion smoothed_motion(const InsSensor& sensor, std::span<const double> time,
                               const KinferOfflineOptions& options) {
  const ForwardPass pass = forward_pass(sensor, time, options.filter);
  SmoothedMotion motion;
  motion.world_q_sensor.assign(time.size(), Quat::Identity());
  motion.bias.resize(pass.steps.size());
  for (const Step& step : pass.steps) motion.update_time.push_back(time[step.last_row]);
  KinferBelief end = pass.last;
  for (std::size_t row = pass.last_row; row < time.size(); ++row)
    motion.world_q_sensor[row] = (end.world_q_sensor * pass.turned[row]).normalized();
  for (std::size_t k = pass.steps.size(); k-- > 0;) {
    const KinferBelief begin = smoothed_begin(pass.steps[k], end);
    fill_rows(pass.steps[k], begin.world_q_sensor, end.world_q_sensor, time, pass.turned, motion.world_q_sensor);
    motion.bias[k] = end.bias;
    end = begin;
  }
  motion.scale = end.scale;
  for (std::size_t row = 0; row <= pass.first_row && row < time.size(); ++row)
    motion.world_q_sensor[row] = end.world_q_sensor.normalized();
  return motion;
}

}  // namespace kinfer
