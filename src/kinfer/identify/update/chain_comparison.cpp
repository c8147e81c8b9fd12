// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/update/chain_comparison.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/identify/handover/known_joint.hpp"
#include "kinfer/identify/update/thresholds.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;
using Kind = TrackingParameterKind;

bool is_rotation(const TrackingParameter& parameter) {
  return parameter.kind == Kind::parent_rotation || parameter.kind == Kind::child_rotation;
}

Index row_of(const TrackingModel& model, const TrackingParameter& parameter) {
  return std::ranges::find(model.parameters, parameter) - model.parameters.begin();
}

/// Geometry that both models estimate, but for the zeros of revolute joints.
std::vector<TrackingParameter> shared_geometry(const TrackingModel& known, const TrackingModel& fresh) {
  std::vector<TrackingParameter> shared;
  for (const TrackingParameter& p : known.parameters)
    if (p.kind <= Kind::point_in_child && !is_zero_of_revolute(known, p) &&
        row_of(fresh, p) < std::ssize(fresh.parameters))
      shared.push_back(p);
  return shared;
}

MatrixXd covariance_of(const TrackingModel& model, const std::vector<TrackingParameter>& parameters) {
  std::vector<Index> rows;
  for (const TrackingParameter& p : parameters) rows.push_back(row_of(model, p));
  return model.covariance(rows, rows);
}

/// The zero of a slide is a shift along its axis, which says nothing of the machine.
void free_slides(MatrixXd& covariance, VectorXd& value, const TrackingModel& model,
                 const std::vector<TrackingParameter>& parameters) {
  constexpr double anywhere = 10.0;  // [m]
  for (std::size_t i = 0; i + 2 < parameters.size(); ++i) {
    const TrackingParameter& p = parameters[i];
    const TrackingBody& body = model.bodies[static_cast<std::size_t>(p.index)];
    if (p.kind != Kind::point_in_parent || p.component != 0 || body.motion != TrackingMotion::prismatic) continue;
    const auto first = static_cast<Index>(i);
    const Vec3 axis = body.parent_R_axis.col(2);
    value.segment<3>(first) -= axis * axis.dot(value.segment<3>(first));
    covariance.block<3, 3>(first, first) += anywhere * anywhere * axis * axis.transpose();
  }
}

ChangeHypothesis hypothesis_of(const TrackingModel& model, const ChainCause& cause,
                               const std::vector<TrackingParameter>& parameters) {
  return {effect_of(model, cause, parameters), rotations_of(cause),
          cause.kind == ChainChangeKind::sensor_moved ? moved_sensor_probability : moved_joint_probability};
}

/// Norm of some components of a size with its standard deviation; none where the prior is all there is.
std::optional<ChangeSize> size_of(ConstVectorRef mean, ConstMatrixRef covariance, double prior) {
  const double norm = mean.norm();
  const VectorXd along = norm > 0.0 ? VectorXd(mean / norm) : VectorXd::Unit(mean.size(), 0);
  const double sd = std::sqrt(std::max(0.0, along.dot(covariance * along)));
  if (sd > unknown_size * prior) return {};
  return ChangeSize{norm, sd};
}

/// The components of a cause about the machine that it has already moved; those of a sensor are stated in its old
/// frame.
VectorXd about_moved(const FoundCause& found) {
  VectorXd size = found.size;
  if (found.cause.kind == ChainChangeKind::sensor_moved)
    size.tail<3>() = exp_so3(found.size.head<3>()).transpose() * found.size.tail<3>();
  return size;
}

/// `step`: a further change of the machine that the cause has already moved.
void add(FoundCause& found, ConstVectorRef step) {
  if (found.cause.kind == ChainChangeKind::joint_moved) {
    found.size += step;
    return;
  }
  const Mat3 turn = exp_so3(found.size.head<3>());
  found.size.tail<3>() += turn * step.tail<3>();
  found.size.head<3>() = log_so3(turn * exp_so3(step.head<3>()));
}

void set_change(FoundCause& found, ConstMatrixRef covariance) {
  const Index turns = rotations_of(found.cause);
  const VectorXd size = about_moved(found);
  found.change.angle = size_of(size.head(turns), covariance.topLeftCorner(turns, turns), change_angles.back());
  found.change.distance = size_of(size.tail<3>(), covariance.bottomRightCorner<3, 3>(), change_distances.back());
}

TrackingModel moved_by(TrackingModel model, const std::vector<FoundCause>& causes) {
  for (const FoundCause& found : causes) model = changed(model, found.cause, found.size);
  return model;
}

/// Estimates the sizes of the causes together, about the machine that they have already moved.
void estimate_sizes(std::vector<FoundCause>& causes, const TrackingModel& known, const TrackingModel& fresh) {
  constexpr int turns = 6;  // Gauss-Newton; large rotations are not small
  for (int turn = 0; turn < turns && !causes.empty(); ++turn) {
    const TrackingModel moved = moved_by(known, causes);
    const GeometryDifference d = geometry_difference(moved, fresh);
    std::vector<ChangeHypothesis> hypotheses;
    for (const FoundCause& found : causes) hypotheses.push_back(hypothesis_of(moved, found.cause, d.parameters));
    const ChangeEstimate step =
        estimate_changes(d.value, d.covariance, hypotheses, change_angles.back(), change_distances.back());
    Index at = 0;
    for (FoundCause& found : causes) {
      const Index size = components_of(found.cause);
      add(found, step.mean.segment(at, size));
      set_change(found, step.covariance.block(at, at, size, size));
      at += size;
    }
  }
}

std::string identity_of(const FoundCause& found) {
  return found.cause.name + " " + found.cause.segment;
}

/// Chooses causes once, about the machine that the causes found before have moved.
std::vector<FoundCause> choose_causes(const std::vector<FoundCause>& before, const TrackingModel& known,
                                      const TrackingModel& fresh) {
  const TrackingModel moved = moved_by(known, before);
  GeometryDifference d = geometry_difference(moved, fresh);
  const std::vector<ChainCause> causes = possible_causes(known);
  std::vector<ChangeHypothesis> hypotheses;
  for (const ChainCause& cause : causes) hypotheses.push_back(hypothesis_of(moved, cause, d.parameters));
  for (const FoundCause& found : before)
    d.value += hypothesis_of(moved, found.cause, d.parameters).effect * about_moved(found);
  std::vector<FoundCause> result;
  for (const ChosenChange& chosen : choose_changes(d.value, d.covariance, hypotheses)) {
    const ChainCause& cause = causes[chosen.hypothesis];
    result.push_back({cause,
                      VectorXd::Zero(components_of(cause)),
                      {.kind = cause.kind,
                       .name = cause.name,
                       .segment = cause.segment,
                       .alternative = cause.alternative,
                       .log_odds = chosen.log_odds}});
  }
  return result;
}

/// One for the parameters of a body that have the same kind.
std::vector<ChainPartComparison> compare_parts(const GeometryDifference& d, const TrackingModel& model) {
  std::vector<ChainPartComparison> parts;
  const std::vector<KnownJoint> joints = known_joints(model);
  for (std::size_t begin = 0, end = 0; begin < d.parameters.size(); begin = end) {
    const TrackingParameter& first = d.parameters[begin];
    while (end < d.parameters.size() && d.parameters[end].kind == first.kind && d.parameters[end].index == first.index)
      ++end;
    const KnownJoint& joint =
        joints[static_cast<std::size_t>(model.bodies[static_cast<std::size_t>(first.index)].joint)];
    const bool in_parent = first.kind == Kind::parent_rotation || first.kind == Kind::point_in_parent;
    const auto at = static_cast<Index>(begin), size = static_cast<Index>(end - begin);
    const MatrixXd covariance = d.covariance.block(at, at, size, size);
    parts.push_back({.joint = joint.parent + "-" + joint.child,
                     .sensor = in_parent ? joint.parent : joint.child,
                     .quantity = is_rotation(first) ? ChainPartQuantity::axis : ChainPartQuantity::point,
                     .difference = d.value.segment(at, size).norm(),
                     .sd = std::sqrt(covariance.trace()),
                     .squared_distance = squared_distance(d.value.segment(at, size), covariance),
                     .freedom = static_cast<int>(size)});
  }
  return parts;
}

}  // namespace

GeometryDifference geometry_difference(const TrackingModel& known, const TrackingModel& fresh) {
  GeometryDifference d{.parameters = shared_geometry(known, fresh), .value = {}, .covariance = {}};
  const TrackingModel other = aligned_model(fresh, known);
  d.value = difference(known.bodies, other.bodies, d.parameters);
  d.covariance = covariance_of(known, d.parameters) + covariance_of(other, d.parameters);
  for (std::size_t i = 0; i < d.parameters.size(); ++i) {
    const double same = is_rotation(d.parameters[i]) ? same_angle : same_distance;
    d.covariance(static_cast<Index>(i), static_cast<Index>(i)) += same * same;
  }
  free_slides(d.covariance, d.value, known, d.parameters);
  return d;
}

ChainComparison compare_chains(const TrackingModel& known, const TrackingModel& fresh) {
  constexpr int rounds = 3;  // the causes are chosen again where they have moved the machine
  ChainComparison result{.update = {}, .causes = {}, .moved = known};
  for (int round = 0; round < rounds; ++round) {
    std::vector<FoundCause> causes = choose_causes(result.causes, known, fresh);
    const bool is_same = std::ranges::equal(causes, result.causes, {}, identity_of, identity_of);
    result.causes = std::move(causes);
    estimate_sizes(result.causes, known, fresh);
    if (is_same) break;
  }
  result.moved = moved_by(known, result.causes);
  for (const FoundCause& found : result.causes) result.update.changes.push_back(found.change);
  result.update.parts = compare_parts(geometry_difference(known, fresh), known);
  const GeometryDifference left = geometry_difference(result.moved, fresh);
  result.update.squared_distance = squared_distance(left.value, left.covariance);
  result.update.freedom = static_cast<int>(left.value.size());
  result.update.is_other_machine =
      static_cast<double>(result.causes.size()) > max_changes_per_sensor * static_cast<double>(known.sensors.size());
  return result;
}

}  // namespace kinfer::identify
