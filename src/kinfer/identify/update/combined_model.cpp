// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/update/combined_model.hpp"

#include <algorithm>

#include "kinfer/identify/handover/known_joint.hpp"
#include "kinfer/identify/update/bent_axes.hpp"
#include "kinfer/identify/update/thresholds.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;
using Kind = TrackingParameterKind;

bool is_geometry(const TrackingParameter& p) {
  return p.kind <= Kind::point_in_child;
}

bool is_bias(const TrackingParameter& p) {
  return p.kind == Kind::gyroscope_bias || p.kind == Kind::accelerometer_bias;
}

/// A parameter of a sensor that is not geometry.
double& sensor_value(TrackingModel& model, const TrackingParameter& p) {
  TrackingSensor& sensor = model.sensors[static_cast<std::size_t>(p.index)];
  if (p.kind == Kind::gyroscope_bias) return sensor.gyroscope_bias[p.component];
  if (p.kind == Kind::accelerometer_bias) return sensor.accelerometer_bias[p.component];
  Mat3& matrix = p.kind == Kind::gyroscope_scale ? sensor.gyroscope_scale : sensor.accelerometer_scale;
  return matrix(p.component % 3, p.component / 3);
}

double prior_sd(const TrackingPrior& prior, const TrackingParameter& p) {
  switch (p.kind) {
    case Kind::parent_rotation:
    case Kind::child_rotation:
      return prior.rotation;
    case Kind::point_in_parent:
    case Kind::point_in_child:
      return prior.point;
    case Kind::gyroscope_bias:
      return prior.bias.rate;
    case Kind::accelerometer_bias:
      return prior.bias.force;
    case Kind::gyroscope_scale:
      return prior.scale.rate;
    case Kind::accelerometer_scale:
      return prior.scale.force;
  }
  return 0.0;
}

/// Geometry, zeros and scale matrices of the older model and biases of the newer log, before that log was seen.
struct PriorState {
  std::vector<TrackingParameter> parameters;
  VectorXd value;  ///< geometry: 0
  MatrixXd covariance;
};

Index row_in(const std::vector<TrackingParameter>& list, const TrackingParameter& p) {
  return std::ranges::find(list, p) - list.begin();
}

PriorState prior_state(const ChainComparison& comparison, const TrackingModel& fresh) {
  TrackingModel known = comparison.moved;
  PriorState state;
  std::vector<Index> from;  // rows of the older model; −1: none
  for (const TrackingParameter& p : fresh.parameters) {
    const Index row = row_in(known.parameters, p);
    const bool is_there = !is_bias(p) && row < std::ssize(known.parameters);
    if (!is_there && is_zero_of_revolute(known, p)) continue;
    state.parameters.push_back(p);
    from.push_back(is_there ? row : -1);
  }
  const auto size = std::ssize(state.parameters);
  state.value = VectorXd::Zero(size);
  state.covariance = MatrixXd::Zero(size, size);
  for (Index i = 0; i < size; ++i) {
    const TrackingParameter& p = state.parameters[static_cast<std::size_t>(i)];
    const Index row = from[static_cast<std::size_t>(i)];
    if (row < 0) {
      const double sd = prior_sd(fresh.prior, p);
      state.covariance(i, i) = sd * sd;
      continue;
    }
    if (!is_geometry(p)) state.value[i] = sensor_value(known, p);
    for (Index k = 0; k < size; ++k)
      if (const Index other = from[static_cast<std::size_t>(k)]; other >= 0)
        state.covariance(i, k) = known.covariance(row, other);
  }
  return state;
}

/// What changed is forgotten.
void forget_changes(PriorState& state, const ChainComparison& comparison) {
  for (const FoundCause& found : comparison.causes) {
    std::vector<TrackingParameter> geometry;
    for (const TrackingParameter& p : state.parameters)
      if (is_geometry(p)) geometry.push_back(p);
    MatrixXd effect = MatrixXd::Zero(std::ssize(state.parameters), components_of(found.cause));
    const MatrixXd of_geometry = effect_of(comparison.moved, found.cause, geometry);
    for (std::size_t i = 0; i < geometry.size(); ++i)
      effect.row(row_in(state.parameters, geometry[i])) = of_geometry.row(static_cast<Index>(i));
    effect.leftCols(rotations_of(found.cause)) *= forgotten_angle;
    effect.rightCols<3>() *= forgotten_distance;
    state.covariance += times_transposed(effect, effect);
  }
}

/// Of axes that are on a cone by this model, and less so by the other, what it tells is forgotten.
void forget_bent_axes(MatrixXd& covariance, const std::vector<TrackingParameter>& parameters,
                      const std::vector<double>& bends, const std::vector<double>& other) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const TrackingParameter& p = parameters[i];
    const auto body = static_cast<std::size_t>(p.index);
    const auto row = static_cast<Index>(i);
    if (p.kind == Kind::parent_rotation && bends[body] > max_axis_bend && bends[body] >= other[body])
      covariance(row, row) += forgotten_angle * forgotten_angle;
  }
}

/// Orthonormal combinations of state parameters that the newer log estimates: without zeros. That of a slide is a shift
/// along its axis.
MatrixXd estimated_rows(const PriorState& state, const TrackingModel& known) {
  const auto size = std::ssize(state.parameters);
  MatrixXd kept = MatrixXd::Identity(size, size);
  for (Index i = 0; i < size; ++i) {
    const TrackingParameter& p = state.parameters[static_cast<std::size_t>(i)];
    if (is_zero_of_revolute(known, p)) kept(i, i) = 0.0;
    if (p.kind != Kind::point_in_parent || p.component != 0) continue;
    const TrackingBody& body = known.bodies[static_cast<std::size_t>(p.index)];
    if (body.motion != TrackingMotion::prismatic) continue;
    const Vec3 axis = body.parent_R_axis.col(2);
    kept.block<3, 3>(i, i) -= axis * axis.transpose();
  }
  const SymmetricEigen eigen = symmetric_eigen(kept);
  const Index zeros = (eigen.values.array() < 0.5).count();
  return eigen.vectors.rightCols(size - zeros).transpose();
}

/// Independent measurements of combinations of the state, by the newer log alone.
struct LogEstimate {
  MatrixXd rows;
  VectorXd deviation;  ///< from the state's value
  VectorXd variance;
};

/// The newer estimate less its prior's mean: of sensors 0, of geometry where its fit began. `fresh`: aligned with
/// `known`.
VectorXd deviations(const PriorState& state, const TrackingModel& known, TrackingModel fresh) {
  VectorXd result(state.value.size());
  for (std::size_t i = 0; i < state.parameters.size(); ++i) {
    const TrackingParameter& p = state.parameters[i];
    result[static_cast<Index>(i)] =
        is_geometry(p) ? difference(known.bodies, fresh.bodies, {p})[0] : sensor_value(fresh, p);
  }
  return result;
}

MatrixXd fresh_covariance(const PriorState& state, const TrackingModel& fresh) {
  std::vector<Index> rows;
  for (const TrackingParameter& p : state.parameters) rows.push_back(row_in(fresh.parameters, p));
  return fresh.covariance(rows, rows);
}

LogEstimate log_estimate(const PriorState& state, const TrackingModel& known, const TrackingModel& fresh) {
  constexpr double nothing = 0.999, floor = 1e-14;  // of the prior's variance
  VectorXd prior(state.value.size());
  for (std::size_t i = 0; i < state.parameters.size(); ++i)
    prior[static_cast<Index>(i)] = prior_sd(fresh.prior, state.parameters[i]);
  const MatrixXd white = estimated_rows(state, known) * prior.cwiseInverse().asDiagonal();
  const SymmetricEigen eigen = symmetric_eigen(propagated_covariance(white, fresh_covariance(state, fresh)));
  std::vector<Index> told;
  for (Index i = 0; i < eigen.values.size(); ++i)
    if (eigen.values[i] < nothing) told.push_back(i);
  LogEstimate estimate;
  estimate.rows = transposed_times(eigen.vectors(Eigen::all, told), white);
  const VectorXd share = eigen.values(told).cwiseMax(floor);
  estimate.variance = share.array() / (1.0 - share.array());
  const VectorXd by_log = (estimate.rows * deviations(state, known, fresh)).array() / (1.0 - share.array());
  estimate.deviation = by_log - estimate.rows * state.value;
  return estimate;
}

/// Kalman update; returns the change of the state.
VectorXd update(MatrixXd& covariance, const LogEstimate& log) {
  const MatrixXd cross = times_transposed(covariance, log.rows);  // P Hᵀ
  MatrixXd innovation = product(log.rows, cross);
  innovation.diagonal() += log.variance;
  const MatrixXd gain = product(cross, invert_but_for_rounding(0.5 * (innovation + innovation.transpose())));
  const MatrixXd left = MatrixXd::Identity(covariance.rows(), covariance.cols()) - product(gain, log.rows);
  const MatrixXd noise = gain * log.variance.cwiseSqrt().asDiagonal();
  covariance = propagated_covariance(left, covariance) + times_transposed(noise, noise);
  covariance = 0.5 * (covariance + covariance.transpose()).eval();
  return gain * log.deviation;
}

void apply(TrackingModel& model, const PriorState& state, const VectorXd& step) {
  std::vector<BodyDifference> changes(model.bodies.size(), BodyDifference::Zero());
  for (std::size_t i = 0; i < state.parameters.size(); ++i) {
    const TrackingParameter& p = state.parameters[i];
    const auto row = static_cast<Index>(i);
    if (is_geometry(p))
      changes[static_cast<std::size_t>(p.index)][3 * static_cast<Index>(p.kind) + p.component] = step[row];
    else
      sensor_value(model, p) = state.value[row] + step[row];
  }
  for (std::size_t b = 0; b < model.bodies.size(); ++b) model.bodies[b] = retracted(model.bodies[b], changes[b]);
}

void shift_ranges(TrackingModel& model, const VectorXd& offsets) {
  for (TrackingJoint& joint : model.joints)
    for (std::size_t i = 0; i < joint.range.size(); ++i) {
      const double offset = offsets[joint.first_position + static_cast<Index>(i)];
      joint.range[i].lower -= offset;
      joint.range[i].upper -= offset;
    }
}

}  // namespace

TrackingModel combined(const ChainComparison& comparison, const TrackingModel& fresh) {
  PriorState state = prior_state(comparison, fresh);
  forget_changes(state, comparison);
  TrackingModel log = aligned_model(fresh, comparison.moved);
  const std::vector<double> of_known = axis_bends(comparison.moved), of_log = axis_bends(log);
  forget_bent_axes(state.covariance, state.parameters, of_known, of_log);
  forget_bent_axes(log.covariance, log.parameters, of_log, of_known);
  const VectorXd step = update(state.covariance, log_estimate(state, comparison.moved, log));
  TrackingModel result = fresh;
  result.bodies = comparison.moved.bodies;
  apply(result, state, step);
  result.parameters = state.parameters;
  result.covariance = state.covariance;
  result.tool = comparison.moved.tool;
  shift_ranges(result, zero_offsets(fresh, result));
  expect_well_formed(result);
  return result;
}

}  // namespace kinfer::identify
