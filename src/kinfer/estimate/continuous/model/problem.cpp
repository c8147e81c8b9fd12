// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/model/problem.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr double certain = 1e-9;  // [s], [s/s] of the reference clock, which is exact by definition

/// Calls visit(first unknown, size, pointer to value, sd) for each part of a sensor's errors.
template <class Errors, class Visit>
void each_error(const InsProblem& problem, const InsLayout& layout, Errors& all, std::size_t sensor,
                const Visit& visit) {
  auto& errors = all[sensor];
  const Index first = layout.error[sensor];
  visit(first, 3, errors.gyroscope_bias.data(), problem.prior.gyroscope_bias);
  visit(first + 3, 3, errors.accelerometer_bias.data(), problem.prior.accelerometer_bias);
  if (layout.has_matrices) {
    const InsScaleFactor factor = problem.scale_factors.empty() ? InsScaleFactor{} : problem.scale_factors[sensor];
    visit(first + 6, 9, errors.gyroscope_scale.data(), factor.gyroscope * problem.prior.gyroscope_scale);
    visit(first + 15, 9, errors.accelerometer_scale.data(), factor.accelerometer * problem.prior.accelerometer_scale);
  }
  if (layout.has_tilts) visit(first + layout.tilt_error, 9, errors.tilt.data(), problem.prior.tilt);
  if (!layout.has_clocks) return;
  const bool is_reference = sensor == problem.clock_reference;
  const Index clock = first + layout.clock_error;
  visit(clock, 1, &errors.clock.offset, is_reference ? certain : problem.prior.clock_offset);
  visit(clock + 1, 1, &errors.clock.drift, is_reference ? certain : problem.prior.clock_drift);
}

/// Diagonal elements of the scale matrices of all instruments of a kind, with the information of their own priors.
struct CommonElements {
  std::vector<Index> at;
  std::vector<double> value, information;
};

CommonElements common_elements(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                               bool is_gyroscope) {
  CommonElements elements;
  for (std::size_t s = 0; s < x.errors.size(); ++s) {
    const InsScaleFactor factor = problem.scale_factors.empty() ? InsScaleFactor{} : problem.scale_factors[s];
    const double sd = is_gyroscope ? factor.gyroscope * problem.prior.gyroscope_scale
                                   : factor.accelerometer * problem.prior.accelerometer_scale;
    const Mat3& matrix = is_gyroscope ? x.errors[s].gyroscope_scale : x.errors[s].accelerometer_scale;
    for (Index k = 0; k < 3; ++k) {
      elements.at.push_back(layout.error[s] + (is_gyroscope ? 6 : 15) + 4 * k);
      elements.value.push_back(matrix(k, k));
      elements.information.push_back(1.0 / (sd * sd));
    }
  }
  return elements;
}

/// With a common factor of variance σ² along a, the information W of their own priors becomes
/// W − W a (1/σ² + aᵀ W a)⁻¹ aᵀ W (Woodbury's identity).
void allow_common_scale(GlobalParameterPrior& prior, const CommonElements& elements, const InsCommonScale& common) {
  if (common.is_none()) return;
  double total = 0.0, weighted = 0.0;
  for (std::size_t i = 0; i < elements.at.size(); ++i)
    total += elements.information[i], weighted += elements.information[i] * elements.value[i];
  const double share = 1.0 / (1.0 / (common.sd * common.sd) + total);
  prior.cost -= share * weighted * weighted;
  for (std::size_t i = 0; i < elements.at.size(); ++i) {
    prior.right[elements.at[i]] += share * elements.information[i] * weighted;
    for (std::size_t j = 0; j < elements.at.size(); ++j)
      prior.matrix(elements.at[i], elements.at[j]) -= share * elements.information[i] * elements.information[j];
  }
}

MeasuredSpan united(const MeasuredSpan& a, const MeasuredSpan& b) {
  if (a.begin >= a.end) return b;
  if (b.begin >= b.end) return a;
  return {std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

MeasuredSpan measured_span(const InsMeasurements& sensor) {
  MeasuredSpan span;
  for (const auto* blocks : {&sensor.angular_velocity, &sensor.force})
    for (std::size_t k = 0; k < blocks->size(); ++k)
      if ((*blocks)[k].rows > 0) span = united(span, {static_cast<Index>(k), static_cast<Index>(k) + 1});
  return span;
}

/// A joint moves its own sensor and those beyond; the root's motion moves all.
std::vector<MeasuredSpan> measured_spans(const InsProblem& problem, const InsBodies& bodies, const InsLayout& layout) {
  std::vector<MeasuredSpan> of_body(bodies.size());
  for (std::size_t b = bodies.size(); b-- > 0;) {
    if (bodies[b].sensor >= 0)
      of_body[b] = united(of_body[b], measured_span(problem.sensors[static_cast<std::size_t>(bodies[b].sensor)]));
    if (bodies[b].parent >= 0) {
      MeasuredSpan& parent = of_body[static_cast<std::size_t>(bodies[b].parent)];
      parent = united(parent, of_body[b]);
    }
  }
  for (MeasuredSpan& span : of_body)
    if (span.begin >= span.end) span = {0, problem.grid.intervals};  // nothing to extrapolate from
  std::vector<MeasuredSpan> of_dimension(static_cast<std::size_t>(layout.spline_dimensions),
                                         of_body.empty() ? MeasuredSpan{} : of_body.front());
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (Index i = 0; layout.spline_dimension[b] >= 0 && i < degrees_of_freedom(bodies[b].motion); ++i)
      of_dimension[static_cast<std::size_t>(layout.spline_dimension[b] + i)] = of_body[b];
  return of_dimension;
}

/// Slides that nothing rotates, of a root at rest: no measurement shows where they are or how fast they move.
std::vector<bool> accelerating_dimensions(const InsProblem& problem, const InsBodies& bodies, const InsLayout& layout) {
  std::vector<bool> found(static_cast<std::size_t>(layout.spline_dimensions), false), is_turned(bodies.size(), false);
  if (!problem.root_at_rest) return found;
  for (std::size_t b = 1; b < bodies.size(); ++b) {
    const InsBody& body = bodies[b];
    const bool rotates = body.motion == JointMotion::revolute || body.motion == JointMotion::spherical;
    is_turned[b] = rotates || is_turned[static_cast<std::size_t>(body.parent)];
    if (body.motion == JointMotion::prismatic && !is_turned[b])
      found[static_cast<std::size_t>(layout.spline_dimension[b])] = true;
  }
  return found;
}

}  // namespace

InsLayout layout_of(const InsProblem& problem, const InsBodies& bodies) {
  InsLayout layout;
  layout.spline_dimensions = problem.root_at_rest ? 0 : 6;
  layout.has_matrices = problem.prior.gyroscope_scale > 0.0 || problem.prior.accelerometer_scale > 0.0;
  const auto take = [&](Index count) {
    return std::exchange(layout.global_parameters, layout.global_parameters + count);
  };
  if (problem.root_at_rest) layout.root_force = take(3);
  for (const InsBody& body : bodies) {
    layout.body.push_back(take(body.unknowns()));
    layout.spline_dimension.push_back(body.motion == JointMotion::fixed ? -1 : layout.spline_dimensions);
    layout.spline_dimensions += degrees_of_freedom(body.motion);
  }
  layout.measured = measured_spans(problem, bodies, layout);
  layout.only_accelerates = accelerating_dimensions(problem, bodies, layout);
  layout.has_clocks = problem.prior.clock_offset > 0.0;
  const auto append = [&](Index count) { return std::exchange(layout.errors_each, layout.errors_each + count); };
  append(layout.has_matrices ? 24 : 6);
  if (layout.has_clocks) layout.clock_error = append(2);
  layout.has_tilts = problem.prior.tilt > 0.0;
  if (layout.has_tilts) layout.tilt_error = append(9);
  for (std::size_t s = 0; s < problem.sensors.size(); ++s) layout.error.push_back(take(layout.errors_each));
  if (!problem.bias_process.is_none()) layout.bias_process = 6 * static_cast<Index>(problem.sensors.size());
  const InsFacts& facts = problem.facts;
  layout.facts = take(3 * static_cast<Index>(facts.places.size() + facts.touches.size()));
  layout.closures = take(closure_unknowns * static_cast<Index>(facts.closures.size()));
  take(facts.surveyed.empty() ? 0 : 6);
  return layout;
}

GlobalParameterPrior global_parameter_prior(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x) {
  GlobalParameterPrior prior{0.0, MatrixXd::Zero(layout.global_parameters, layout.global_parameters),
                             VectorXd::Zero(layout.global_parameters)};
  const auto hold = [&](Index at, double value, double sd) {
    const double information = 1.0 / (sd * sd);
    prior.cost += value * value * information;
    prior.matrix(at, at) += information;
    prior.right[at] -= value * information;
  };
  if (layout.root_force >= 0) {
    const Vec3 up = x.root_force.normalized();
    const double information = 1.0 / (problem.gravity_sd * problem.gravity_sd),
                 excess = x.root_force.norm() - problem.gravity;
    prior.cost += excess * excess * information;
    prior.matrix.block<3, 3>(layout.root_force, layout.root_force) += information * up * up.transpose();
    prior.right.segment<3>(layout.root_force) -= excess * information * up;
  }
  const auto hold_joint = [&](const InsBody& body, Index at) {
    for (const auto* turns : {&body.free_parent_rotation, &body.free_child_rotation})
      for (const bool is_free : *turns)
        if (is_free) hold(at++, 0.0, problem.rotation_sd);
    for (const auto& [is_free, point] :
         {std::pair{body.free_point_in_parent, body.point_in_parent}, {body.free_point_in_child, body.point_in_child}})
      if (is_free)
        for (const double value : point) hold(at++, value, problem.point_sd);
  };
  for (std::size_t b = 0; b < x.bodies.size(); ++b) hold_joint(x.bodies[b], layout.body[b]);
  for (std::size_t c = 0; c < x.facts.closures.size(); ++c)
    hold_joint(x.facts.closures[c], layout.closures + closure_unknowns * static_cast<Index>(c));
  for (std::size_t s = 0; s < x.errors.size(); ++s)
    each_error(problem, layout, x.errors, s, [&](Index at, Index size, const double* value, double sd) {
      for (Index i = 0; i < size; ++i) hold(at + i, value[i], sd);
    });
  if (layout.has_matrices) {
    allow_common_scale(prior, common_elements(problem, layout, x, true), problem.common.gyroscope);
    allow_common_scale(prior, common_elements(problem, layout, x, false), problem.common.accelerometer);
  }
  for (std::size_t i = 0; i < x.facts.places.size(); ++i) {
    const InsUnknownPoint& place = problem.facts.places[i];
    for (Index k = 0; k < 3; ++k)
      hold(layout.facts + 3 * static_cast<Index>(i) + k, x.facts.places[i][k] - place.start[k], place.sd);
  }
  return prior;
}

}  // namespace kinfer
