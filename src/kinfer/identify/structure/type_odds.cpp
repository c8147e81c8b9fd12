// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/type_odds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/structure/thresholds.hpp"

namespace kinfer::identify {
namespace {

constexpr std::array weighed_types{EstimatedJointType::rigid, EstimatedJointType::prismatic,
                                   EstimatedJointType::revolute, EstimatedJointType::universal,
                                   EstimatedJointType::spherical};
constexpr std::size_t type_count = weighed_types.size(), grid_size = 40;
constexpr double least_deviation = 1e-5;     // [rad] of measurements without error
constexpr double least_acceleration = 1e-4;  // [m/s²] likewise
constexpr double least_rate = 1e-4;          // [rad/s] likewise
constexpr double least_rate_level = relative_rate_noise / rigid_rate_share.median;  // [rad/s] that shares refer to

using Grid = std::array<double, grid_size>;
using LogTypes = std::array<double, type_count>;  // ln p(T) p(d | T, errors)

/// Log density of ln x of an error or a secondary effect, which may well be far smaller than is typical, but not far
/// larger.
double log_error(double x, const LogNormal& of) {
  constexpr double spread_below = 3.0;  // times that above
  return log_density(x < of.median ? of.median * std::pow(x / of.median, 1.0 / spread_below) : x, of);
}

/// Log density of ln r for a ratio that is uniform between 0 and 1: the angles of a joint's axes are alike in size.
double uniform_ratio(double ratio) {
  return std::log(std::min(ratio, 1.0));
}

/// Sizes of errors within five standard deviations of their prior.
Grid sizes_of(const LogNormal& prior) {
  constexpr double reach = 5.0;
  Grid sizes{};
  for (std::size_t i = 0; i < grid_size; ++i)
    sizes[i] = prior.median * std::exp(prior.spread * reach * (2.0 * static_cast<double>(i) / (grid_size - 1) - 1.0));
  return sizes;
}

/// ln p(d | T, s, a) of one joint, for each size of the errors.
struct JointLikelihoods {
  std::array<std::array<double, 4>, grid_size> rotation{};  // rigid and prismatic, revolute, universal, spherical
  Grid rests{};                                             // no translation but errors
  double slides = 0.0;

  LogTypes at(std::size_t orientation, std::size_t acceleration) const {
    const auto& turn = rotation[orientation];
    const double rest = rests[acceleration];
    LogTypes types{turn[0] + rest, turn[0] + slides, turn[1] + rest, turn[2] + rest, turn[3] + rest};
    for (std::size_t type = 0; type < type_count; ++type) types[type] += std::log(type_prior[type]);
    return types;
  }
};

/// Of a joint that moves: what two sensors on one body do not explain is its motion, and so is the relative angular
/// velocity, unless the joint moves in step with its parent.
double moving_rates(const MotionDeviations& d) {
  const double residual = std::hypot(d.rates.residual, least_rate),
               relative = std::hypot(d.rate_share * std::hypot(d.rates.level, least_rate_level), least_rate);
  return log_density(residual, joint_rate) + std::max(log_density(relative / residual, rate_ratio), min_ratio_density);
}

/// Of a rigid pair: noise, what gyroscopes have beyond scale errors, and mounts that give way.
double rigid_rates_of(const MotionDeviations& d, double orientation_error_size) {
  const double expected = std::hypot(std::hypot(d.rates.noise, rigid_residual_share * d.rates.level),
                                     std::hypot(mount_rate * 2.0 * orientation_error_size, least_rate));
  return log_error(std::hypot(d.rates.residual, least_rate) / expected, rigid_residual);
}

void add_rotation(JointLikelihoods& joint, const MotionDeviations& d, const Grid& sizes) {
  const double rotation = std::hypot(d.rotation, least_deviation), axis = std::hypot(d.axis, least_deviation),
               plane = std::hypot(d.plane, least_deviation), share = std::max(d.rate_share, 1e-6);
  const double moves = log_density(rotation, joint_rotation) + moving_rates(d);
  const double second_axis = uniform_ratio(axis / rotation), third_axis = uniform_ratio(plane / axis);
  const double axis_of_errors = std::max(log_density(axis / rotation, error_axis_ratio), min_ratio_density),
               plane_of_errors = std::max(log_density(plane / axis, error_plane_ratio), min_ratio_density);
  const double inclined = std::log(std::max(std::sin(d.axes_angle), 1e-3));  // of two axes in any directions
  for (std::size_t i = 0; i < grid_size; ++i) {
    const auto error = [&](double deviation) { return log_error(deviation, {sizes[i], error_spread}); };
    const double rigid = log_error(rotation, {std::hypot(2.0 * sizes[i], rigid_rotation_error), error_spread}) +
                         log_error(share, rigid_rate_share) + rigid_rates_of(d, sizes[i]);
    joint.rotation[i] = {rigid + axis_of_errors + plane_of_errors, moves + error(axis) + plane_of_errors,
                         moves + second_axis + inclined + error(plane), moves + second_axis + third_axis};
  }
}

void add_translation(JointLikelihoods& joint, const MotionDeviations& d, const Grid& sizes) {
  const double main = std::hypot(d.acceleration, least_acceleration),
               across = std::hypot(d.acceleration_across, least_acceleration);
  const double across_of_errors = std::max(log_density(across / main, error_across_ratio), min_ratio_density);
  const double of_motion = std::hypot(1.0, acceleration_error_share * d.acceleration_level / acceleration_error.median);
  for (std::size_t i = 0; i < grid_size; ++i)
    joint.rests[i] = log_density(main, {of_motion * sizes[i], acceleration_error_spread}) + across_of_errors;
  joint.slides = log_density(main, sliding_acceleration) + log_error(across / main, sliding_across_ratio);
}

/// Posterior of the sizes of the errors.
std::array<Grid, grid_size> posterior(const std::vector<JointLikelihoods>& joints, const Grid& orientation,
                                      const Grid& acceleration) {
  std::array<Grid, grid_size> weight{};
  double largest = -std::numeric_limits<double>::infinity(), sum = 0.0;
  for (std::size_t i = 0; i < grid_size; ++i)
    for (std::size_t k = 0; k < grid_size; ++k) {
      weight[i][k] = log_density(orientation[i], orientation_error) + log_density(acceleration[k], acceleration_error);
      for (const JointLikelihoods& joint : joints) weight[i][k] += log_sum(joint.at(i, k));
      largest = std::max(largest, weight[i][k]);
    }
  for (Grid& row : weight)
    for (double& w : row) sum += w = std::exp(w - largest);
  for (Grid& row : weight)
    for (double& w : row) w /= sum;
  return weight;
}

}  // namespace

std::vector<JointTypeProbabilities> type_probabilities(std::span<const MotionDeviations> joints) {
  const Grid orientation = sizes_of(orientation_error), acceleration = sizes_of(acceleration_error);
  std::vector<JointLikelihoods> likelihoods(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    add_rotation(likelihoods[j], joints[j], orientation);
    add_translation(likelihoods[j], joints[j], acceleration);
  }
  const std::array<Grid, grid_size> weight = posterior(likelihoods, orientation, acceleration);
  std::vector<JointTypeProbabilities> result(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j)
    for (std::size_t i = 0; i < grid_size; ++i)
      for (std::size_t k = 0; k < grid_size; ++k) {
        const LogTypes types = likelihoods[j].at(i, k);
        const double evidence = log_sum(types);
        for (std::size_t t = 0; t < type_count; ++t)
          result[j].of(weighed_types[t]) += weight[i][k] * std::exp(types[t] - evidence);
      }
  return result;
}

}  // namespace kinfer::identify
