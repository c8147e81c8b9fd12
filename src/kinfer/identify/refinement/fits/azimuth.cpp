// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/fits/azimuth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/estimate/continuous/excerpt.hpp"
#include "kinfer/estimate/continuous/fit_comparison.hpp"
#include "kinfer/estimate/continuous/model/azimuth.hpp"
#include "kinfer/estimate/continuous/solver/covariance.hpp"
#include "kinfer/estimate/continuous/solver/normal_equations.hpp"
#include "kinfer/estimate/magnetometers/magnetic_fit.hpp"
#include "kinfer/identify/refinement/fits/thresholds.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

constexpr double max_axis_error = 1.5e-3;  // [rad] of the fit's orientations, which the magnetometers take as given
// Of the search on the circle: six places and more iterations end in the same azimuths on trees 3, 5, 9 and 19.
constexpr int circle_places = 4, circle_iterations = 8, circle_rounds = 2;
// Places are tried on this share of the recording, the windows in which the joints turn most, first.
constexpr Index least_trial_windows = 2, most_trial_windows = 48, windows_of_a_trial_window = 4;
constexpr double undecided_evidence = 30.0;  // −2 log likelihood: odds of 3e6 against a place
constexpr int joint_iterations = 4;          // of the fit with azimuths: it starts within a few standard deviations

/// Azimuths that the fit leaves uncertain, and the information that it has about them.
struct WeakAzimuths {
  std::vector<InsAzimuth> azimuths;
  MatrixXd information;  // [1/rad²]; 0 where it is that of the weak priors only
  VectorXd sd;           // [rad]
};

WeakAzimuths weak_azimuths(const RefinementFit& fitted, int threads) {
  const InsFit& fit = fitted.fit;
  const std::vector<InsAzimuth> all = azimuths_of(fit.unknowns.bodies);
  WeakAzimuths weak;
  if (all.empty()) return weak;
  const auto covariance = model_covariance(InsSystem(fitted.setup.problem, fit.layout, fit.unknowns, {}, threads));
  if (!covariance) return weak;
  std::vector<VectorXd> gradients;
  for (const InsAzimuth& azimuth : all) {
    const VectorXd gradient = azimuth_gradient(fit.layout, fit.unknowns.bodies, azimuth);
    if (!(gradient.dot(covariance->model * gradient) > min_weak_azimuth_sd * min_weak_azimuth_sd)) continue;
    weak.azimuths.push_back(azimuth);
    gradients.push_back(gradient);
  }
  const auto count = static_cast<Index>(gradients.size());
  MatrixXd jacobian(count, fit.layout.global_parameters);
  for (Index i = 0; i < count; ++i) jacobian.row(i) = gradients[static_cast<std::size_t>(i)].transpose();
  const MatrixXd own = propagated_covariance(jacobian, covariance->model);
  weak.sd = own.diagonal().cwiseSqrt();
  weak.information = MatrixXd::Zero(count, count);
  std::vector<Index> known;
  for (Index i = 0; i < count; ++i)
    if (own(i, i) < max_azimuth_prior_sd * max_azimuth_prior_sd) known.push_back(i);
  if (known.empty()) return weak;
  if (const auto information = invert_spd(own(known, known))) weak.information(known, known) = *information;
  return weak;
}

/// The azimuths, then for each joint on the root the angle from which its positions count: nothing tells it but the
/// magnetometers, and nobody asks, yet the root's magnetometer is of use only with it.
std::vector<SubtreeRotation> free_rotations(const InsBodies& bodies, const std::vector<InsAzimuth>& azimuths,
                                            const MagneticRecording& recording) {
  std::vector<SubtreeRotation> rotations;
  for (const InsAzimuth& azimuth : azimuths) {
    SubtreeRotation rotation{azimuth.child, {}};
    for (const Mat3& root_R_body : recording.root_R_body[azimuth.body])
      rotation.axis.push_back(root_R_body * bodies[azimuth.body].child_R_axis.col(2));
    rotations.push_back(std::move(rotation));
  }
  for (std::size_t b = 1; b < bodies.size(); ++b)
    if (bodies[b].parent == 0 && bodies[b].motion == JointMotion::revolute)
      rotations.push_back({b, std::vector<Vec3>(recording.bins, bodies[b].parent_R_axis.col(2))});
  return rotations;
}

/// Of the sensor grade, in the unit of the field.
IronPrior least_iron(const SensorModel& grade, double strength) {
  const bool is_microtesla = strength > 10.0 && strength < 150.0;
  const double unit = is_microtesla ? 1.0 : strength / 50.0;
  const InstrumentModel& magnetometer = grade.magnetometer;
  const double scale = std::hypot(magnetometer.scale_sd, 1e-3);
  return {.hard_iron = unit * std::hypot(magnetometer.bias_sd, 0.05),
          .soft_iron = scale,
          .misalignment = std::hypot(scale / std::numbers::sqrt2, max_axis_error)};
}

MatrixXd with_zeros(ConstMatrixRef matrix, Index size) {
  MatrixXd result = MatrixXd::Zero(size, size);
  result.topLeftCorner(matrix.rows(), matrix.cols()) = matrix;
  return result;
}

/// The first unknowns of a Gaussian, the others marginalised.
std::optional<MatrixXd> marginal_information(ConstMatrixRef information, Index count) {
  const auto covariance = invert_spd(information);
  return covariance ? invert_spd(covariance->topLeftCorner(count, count)) : std::nullopt;
}

void fit_with_azimuths(const RefinementTask& task, RefinementFit& fitted) {
  InsFitOptions options = task.options;
  options.iterations = joint_iterations;
  options.trajectory_iterations = 0;
  options.reweighting_rounds = 1;
  fitted.fit = fit_ins(fitted.setup.problem, fitted.fit.unknowns, options);
}

std::vector<InsNoise> noise_of(const InsProblem& problem) {
  std::vector<InsNoise> noise;
  for (const InsMeasurements& sensor : problem.sensors) noise.push_back(sensor.noise);
  return noise;
}

void set_noise(InsProblem& problem, const std::vector<InsNoise>& noise) {
  for (std::size_t s = 0; s < noise.size(); ++s) problem.sensors[s].noise = noise[s];
}

/// Tells by a part of the recording which places on the circle are out of the question, in a fraction of the time.
class AzimuthTrial {
 public:
  AzimuthTrial(const RefinementTask& task, const RefinementFit& fitted)
      : options_(task.options), excerpt_(excerpt_of(fitted.setup.problem, fitted.fit.unknowns, trial_windows(fitted))) {
    options_.iterations = circle_iterations, options_.reweighting_rounds = circle_rounds;
    options_.trajectory_iterations = 0;
    if (excerpt_.problem.grid.intervals > 0) reference_ = fitted_value(excerpt_.start);
  }

  bool is_possible(const InsAzimuth& azimuth, double angle) const {
    if (excerpt_.problem.grid.intervals == 0) return true;  // too short to be divided
    InsUnknowns start = excerpt_.start;
    rotate_azimuth(start.bodies, azimuth, angle);
    return fitted_value(start) < reference_ + undecided_evidence;
  }

 private:
  static std::vector<Index> trial_windows(const RefinementFit& fitted) {
    const InsProblem& problem = fitted.setup.problem;
    const Index windows = problem.grid.intervals / excerpt_window;
    return most_informative_windows(
        problem, fitted.fit.unknowns.bodies,
        std::clamp(windows / windows_of_a_trial_window, least_trial_windows, most_trial_windows));
  }

  double fitted_value(const InsUnknowns& start) const {
    InsProblem problem = excerpt_.problem;
    const InsFit fit = fit_ins(problem, start, options_);
    return negative_log_likelihood(problem, fit.cost);
  }

  InsFitOptions options_;
  InsExcerpt excerpt_;
  double reference_ = 0.0;
};

}  // namespace

double azimuth_sd(const InsLayout& layout, const InsBodies& bodies, ConstMatrixRef covariance, std::size_t body) {
  double longest = min_azimuth_lever, sd = 0.0;
  for (std::size_t next = body + 1; next < bodies.size(); ++next) {
    if (bodies[next].parent != static_cast<int>(body) || !bodies[next].free_parent_rotation[0]) continue;
    const InsAzimuth azimuth{body, next};
    const Vec3 axis = bodies[body].child_R_axis.col(2);
    const double lever = axis.cross(bodies[next].parent_R_axis.col(2)).norm();
    if (lever <= longest && longest > min_azimuth_lever) continue;
    longest = std::max(longest, lever);
    const VectorXd gradient = azimuth_gradient(layout, bodies, azimuth);
    if (gradient.squaredNorm() > 0.0) sd = std::sqrt(std::max(0.0, gradient.dot(covariance * gradient)));
  }
  return sd;
}

void search_azimuths(const RefinementTask& task, RefinementFit& fitted, const Observer& observer) {
  InsProblem& problem = fitted.setup.problem;
  if (!problem.root_at_rest) return;
  const WeakAzimuths weak = weak_azimuths(fitted, task.options.threads);
  double lowest = negative_log_likelihood(problem, fitted.fit.cost);
  const double before = lowest;
  const auto continue_from = [&](const InsUnknowns& start, int iterations, int rounds) {
    const std::vector<InsNoise> noise = noise_of(problem);
    InsFitOptions options = task.options;
    options.iterations = iterations, options.reweighting_rounds = rounds, options.trajectory_iterations = 0;
    InsFit other = fit_ins(problem, start, options, observer);
    const double value = negative_log_likelihood(problem, other.cost);
    const bool is_better = value < lowest;
    if (is_better)
      lowest = value, fitted.fit = std::move(other);
    else
      set_noise(problem, noise);
    return is_better;
  };
  std::optional<AzimuthTrial> trial;  // of the present fit
  for (std::size_t i = 0; i < weak.azimuths.size(); ++i) {
    if (weak.sd[static_cast<Index>(i)] > max_azimuth_prior_sd) continue;
    const InsUnknowns start = fitted.fit.unknowns;
    if (!trial) trial.emplace(task, fitted);
    bool is_moved = false;
    for (int k = 1; k < circle_places; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / circle_places;
      if (!trial->is_possible(weak.azimuths[i], angle)) continue;
      InsUnknowns x = start;
      rotate_azimuth(x.bodies, weak.azimuths[i], angle);
      is_moved |= continue_from(x, circle_iterations, circle_rounds);
    }
    if (is_moved) trial.reset();
  }
  if (lowest < before)
    continue_from(InsUnknowns(fitted.fit.unknowns), task.options.iterations, task.options.reweighting_rounds);
}

void measure_azimuths(const RefinementTask& task, RefinementFit& fitted) {
  InsProblem& problem = fitted.setup.problem;
  InsUnknowns& x = fitted.fit.unknowns;
  if (!problem.root_at_rest || std::ranges::count_if(task.recording.sensors, &InsSensor::has_magnetometer) < 2) return;
  const WeakAzimuths weak = weak_azimuths(fitted, task.options.threads);
  if (weak.azimuths.empty()) return;
  const MagneticRecording recording = magnetic_recording(task.recording, problem, fitted.fit.layout, x);
  const auto rotations = free_rotations(x.bodies, weak.azimuths, recording);
  const auto size = static_cast<Index>(rotations.size()), count = static_cast<Index>(weak.azimuths.size());
  const auto magnetic = fit_magnetometers(recording, rotations, least_iron(task.grade, recording.strength),
                                          with_zeros(weak.information, size));
  if (!magnetic) return;
  const auto information = marginal_information(magnetic->information, count);
  const auto factor = information ? cholesky(*information) : std::nullopt;
  if (!factor) return;
  InsAzimuthMeasurement measured{.azimuths = weak.azimuths, .directions = {}, .whitening = factor->transpose()};
  InsBodies alone = x.bodies;
  for (Index i = 0; i < count; ++i) {
    const InsAzimuth& azimuth = weak.azimuths[static_cast<std::size_t>(i)];
    rotate_azimuth(alone, azimuth, magnetic->mean[i]);
    rotate_azimuth(x.bodies, azimuth, magnetic->unknowns.rotation[i]);
    measured.directions.push_back(azimuth_direction(alone, azimuth));
  }
  problem.facts.azimuth = std::move(measured);
  if (weak.information.squaredNorm() > 0.0) fit_with_azimuths(task, fitted);
}

}  // namespace kinfer::identify
