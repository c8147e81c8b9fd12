// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/start/initial_frames.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/calibrate/start/fixtures.hpp"
#include "kinfer/calibrate/start/thresholds.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/geometry/fit.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::calibrate {
namespace {

std::vector<Pose> compute_flange_poses(Chain chain, const PoseSet& data) {
  chain.base = Frame{};
  chain.tool = Frame{};
  return evaluate_poses(chain, {}, data, Derivative::no).pose;
}

Vec3 point_on_flange(const Chain& chain, const PointMeasurement& point) {
  const Pose tool = chain.tool.pose();
  return point.target < 0 ? tool.position : tool * chain.targets[point.target].xyz;
}

/// Base from rigid alignment of the measured points with those predicted by the chain.
Chain with_aligned_base(Chain chain, const PoseSet& data, const std::vector<Pose>& base_T_flange) {
  std::vector<Vec3> measured, predicted;
  for (const PointMeasurement& point : data.points) {
    measured.push_back(point.position);
    predicted.push_back(base_T_flange[point.row] * point_on_flange(chain, point));
  }
  chain.base = Frame::from_pose(align_points(measured, predicted));
  return chain;
}

/// Base and tool rotation from the measured orientations: between two poses, the relative rotation vector of the flange
/// in the world is that of the chain in the base frame, rotated by the base.
Chain with_aligned_rotations(Chain chain, const PoseSet& data, const std::vector<Pose>& base_T_flange) {
  std::vector<Vec3> in_world, in_base;
  const auto& all = data.orientations;
  const std::size_t stride = std::max<std::size_t>(
      1, all.size() / thresholds::paired_orientations);  // enough pairs; their number grows with the square
  for (std::size_t i = 0; i < all.size(); i += stride)
    for (std::size_t j = 0; j < i; j += stride) {
      const Mat3 seen = all[i].orientation.toRotationMatrix() * all[j].orientation.toRotationMatrix().transpose();
      const Mat3 predicted_rotation =
          base_T_flange[all[i].row].rotation * base_T_flange[all[j].row].rotation.transpose();
      const Vec3 seen_vector = log_so3(seen), made_vector = log_so3(predicted_rotation);
      if (std::max(seen_vector.norm(), made_vector.norm()) > thresholds::max_relative_rotation) continue;
      in_world.push_back(seen_vector);
      in_base.push_back(made_vector);
    }
  if (in_world.size() < 3) return chain;
  // No centroid: rotation vectors are compared about zero. A mirrored copy of each vector makes the centroid zero.
  const std::size_t n = in_world.size();
  for (std::size_t i = 0; i < n; ++i) {
    in_world.push_back(-in_world[i]);
    in_base.push_back(-in_base[i]);
  }
  const Mat3 world_R_base = align_points(in_world, in_base).rotation;
  std::vector<Mat3> tools;
  for (const OrientationMeasurement& m : all)
    tools.push_back((world_R_base * base_T_flange[m.row].rotation).transpose() * m.orientation.toRotationMatrix());
  chain.base = Frame::from_pose({world_R_base, Vec3::Zero()});
  chain.tool = Frame::from_pose({mean_rotation(tools), chain.tool.xyz});
  return chain;
}

/// Base position and tool position for known rotations: linear least squares.
Chain with_solved_translations(Chain chain, const PoseSet& data, const std::vector<Pose>& base_T_flange) {
  const auto n = static_cast<Eigen::Index>(data.points.size());
  MatrixXd a(3 * n, 6);
  VectorXd b(3 * n);
  const Mat3 world_R_base = chain.base.pose().rotation, flange_R_tool = chain.tool.pose().rotation;
  for (Eigen::Index i = 0; i < n; ++i) {
    const PointMeasurement& point = data.points[i];
    const Pose& flange = base_T_flange[point.row];
    const Vec3 target = point.target < 0 ? Vec3::Zero().eval() : chain.targets[point.target].xyz;
    a.middleRows<3>(3 * i) << Mat3::Identity(), world_R_base * flange.rotation;
    b.segment<3>(3 * i) = point.position - world_R_base * (flange.position + flange.rotation * flange_R_tool * target);
  }
  const VectorXd x = solve_least_squares(a, b, 1e-9);
  chain.base.xyz = x.head<3>();
  chain.tool.xyz = x.tail<3>();
  return chain;
}

/// Tool position and sockets for known rotations: p + R t = s, linear in t and s.
Chain with_solved_tool(Chain chain, const PoseSet& data, const std::vector<Pose>& base_T_flange) {
  const auto n = static_cast<Eigen::Index>(data.contacts.size());
  const auto sockets = static_cast<Eigen::Index>(chain.fixtures.sockets.size());
  MatrixXd a = MatrixXd::Zero(3 * n, 3 + 3 * sockets);
  VectorXd b(3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const SocketContact& contact = data.contacts[i];
    const Pose& flange = base_T_flange[contact.row];
    a.block<3, 3>(3 * i, 0) = flange.rotation;
    a.block<3, 3>(3 * i, 3 + 3 * contact.socket) = -Mat3::Identity();
    b.segment<3>(3 * i) = -flange.position;
  }
  chain.tool.xyz = solve_least_squares(a, b, 1e-9).head<3>();
  return chain;
}

/// Tool rotation from the measured gravity (Wahba 1965), given the upward direction in the base frame.
Chain with_tool_from_tilts(Chain chain, const PoseSet& data, const std::vector<Pose>& base_T_flange,
                           const Vec3& up_in_base) {
  std::vector<Vec3> measured_directions, expected;
  for (const TiltMeasurement& tilt : data.tilts) {
    const Vec3 in_flange = base_T_flange[tilt.row].rotation.transpose() * up_in_base;
    for (const double sign : {1.0, -1.0}) {  // mirrored copies: directions have no centroid
      measured_directions.push_back(sign * tilt.specific_force.normalized());
      expected.push_back(sign * in_flange);
    }
  }
  chain.tool.rotation = align_points(expected, measured_directions).rotation;
  chain.tool.small_rotation.setZero();
  const Vec3 up = -chain.gravity.normalized();
  chain.base.rotation = rotation_between(up_in_base, up).toRotationMatrix();
  chain.base.small_rotation.setZero();
  return chain;
}

/// Residuals of a kind beyond those that its own fixtures absorb: one contact in a socket of unknown place tells
/// nothing.
double redundancy(const ResidualKind& kind, const PoseSet& data, const ParameterSet& frames) {
  const auto is_absorbed = [&](const Parameter* parameter) {
    const auto* number = std::get_if<FixtureNumber>(&parameter->at);
    return number && !kind.traits.fixture.empty() && number->kind == fixture_kind(kind.traits.fixture) &&
           !std::isfinite(parameter->prior_sd);
  };
  const std::vector<const Parameter*> free = frames.free();
  return kind.size * static_cast<double>(kind.count(data)) -
         static_cast<double>(std::ranges::count_if(free, is_absorbed));
}

/// By how much the noise that explains the measurements would be larger with `a` than with `b` [1]: the ratio of the
/// median residuals of each kind, the geometric mean over the kinds by their redundancies. With an unknown noise level
/// of each kind that is the ratio of likelihoods.
double noise_ratio(const Chain& a, const Chain& b, const PoseSet& data, const ParameterSet& frames) {
  const auto level = [&](const ResidualKind& kind, const Chain& chain) {
    return std::max(thresholds::smallest_residual, median(residual_norms(kind.kind, chain, data)));
  };
  double sum = 0.0, weights = 0.0;
  for (const ResidualKind& kind : residual_kinds()) {
    const double weight = std::max(0.0, redundancy(kind, data, frames));
    if (weight == 0.0) continue;
    sum += weight * std::log(level(kind, a) / level(kind, b)), weights += weight;
  }
  return weights > 0.0 ? std::exp(sum / weights) : 1.0;
}

/// Refines all frames together with a robust loss; the noise level of each round is the median residual at its start.
Chain refine_frames(const Chain& start, const PoseSet& data, const ParameterSet& frames) {
  constexpr int rounds = 4;  // the noise level decreases with the residuals
  Chain chain = start;
  for (int i = 0; i < rounds && frames.free_count() > 0; ++i) {
    Weights weights;
    for (const ResidualKind& kind : residual_kinds()) {
      std::vector<double> errors = residual_norms(kind.kind, chain, data);
      const std::size_t count = errors.size();
      const double median_error = count == 0 ? 0.0 : std::max(1e-9, median(std::move(errors)));
      weights.of(kind.kind).assign(count, Vec3::Constant(median_error));
    }
    LeastSquaresOptions options;
    options.loss = Loss::cauchy;
    const Chain from = chain;
    chain =
        unpack(frames, from, least_squares(pose_residuals(from, frames, data, weights), pack(frames, from), options).x);
  }
  return with_small_rotations_folded(chain);
}

Chain with_tool_at_flange(Chain chain) {
  chain.tool.xyz.setZero();
  return chain;
}

/// Initial guesses; the best after refinement is kept.
std::vector<Chain> initial_guesses(const Chain& nominal, const PoseSet& data) {
  const std::vector<Pose> base_T_flange = compute_flange_poses(nominal, data);
  std::vector<Chain> list;
  const bool has_tool_offset = nominal.tool.xyz.norm() > 0.0;  // the tool of the file may belong to another set-up
  if (data.points.size() >= 3) {
    list.push_back(with_aligned_base(nominal, data, base_T_flange));
    if (has_tool_offset) list.push_back(with_aligned_base(with_tool_at_flange(nominal), data, base_T_flange));
    if (!data.orientations.empty())
      list.push_back(
          with_solved_translations(with_aligned_rotations(nominal, data, base_T_flange), data, base_T_flange));
    return list;
  }
  list.push_back(data.orientations.empty() ? nominal : with_aligned_rotations(nominal, data, base_T_flange));
  if (has_tool_offset) list.push_back(with_tool_at_flange(list.front()));
  if (data.contacts.size() >= 4) list.push_back(with_solved_tool(list.front(), data, base_T_flange));
  if (data.tilts.size() >= 3 && data.orientations.empty())
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {1.0, -1.0})
        list.push_back(with_tool_from_tilts(nominal, data, base_T_flange, sign * Vec3::Unit(axis)));
  return list;
}

/// Number of measurements of the kinds whose traits are accepted.
template <class Accepts>
std::size_t count_measurements(const PoseMeasurements& data, Accepts accepts) {
  std::size_t count = 0;
  for_each_list(data, [&]<class M>(const std::vector<M>& list) {
    if (accepts(M::traits.observes)) count += list.size();
  });
  return count;
}

Result<void> check_enough_measurements(const PoseSet& data) {
  std::set<int> rows;
  for (const PointMeasurement& point : data.points) rows.insert(point.row);
  const bool tool_only =
      count_measurements(data, [](const Observes& o) { return o.tool_position && !o.base_position; }) > 0;
  const bool only_orientations =
      rows.empty() && count_measurements(data, [](const Observes& o) { return o.base_rotation; }) > 0;
  if (rows.size() < 3 && !tool_only && !only_orientations)
    return error("the pose set measures {} positions; at least 3 are needed to find the base of the robot",
                 rows.size());
  return {};
}

/// A subset for the start: points and orientations of a few hundred rows determine a frame as well as all of them.
PoseSet subset_for_start(const PoseSet& data) {
  constexpr Eigen::Index most = thresholds::start_rows;
  const std::size_t all = count_measurements(data, [](const Observes&) { return true; });
  const bool further = all > data.points.size() + data.orientations.size();
  if (further || data.rows() <= most) return data;
  std::vector<int> rows;
  for (Eigen::Index i = 0; i < most; ++i) rows.push_back(static_cast<int>(i * data.rows() / most));
  const PoseSet some = select(data, rows);
  return check_enough_measurements(some) ? some : data;
}

/// Frames of one mounting: the chain is in this mounting, the data are its rows.
Result<Chain> estimate_frames(const Chain& nominal, const PoseSet& all) {
  if (auto enough = check_enough_measurements(all); !enough) return forward_error(enough.error());
  const PoseSet data = subset_for_start(all);
  const ParameterSet frames = frame_parameters(nominal, data);
  std::optional<Chain> best;
  for (const Chain& start : initial_guesses(nominal, data)) {
    const Chain candidate = refine_frames(with_initial_fixtures(start, data), data, frames);
    // The file's own frames come first; another guess must be clearly better, because where the poses do not show the
    // tool all are equally good but for noise.
    if (!best || noise_ratio(candidate, *best, data, frames) < thresholds::better_guess) best = candidate;
  }
  return *best;
}

std::vector<int> rows_of_mounting(const PoseSet& data, int mounting) {
  std::vector<int> rows;
  for (int row = 0; row < data.rows(); ++row)
    if (data.mounting[row] == mounting) rows.push_back(row);
  return rows;
}

}  // namespace

Result<Chain> with_estimated_frames(const Chain& nominal, const PoseSet& data) {
  if (data.mounting.empty()) return estimate_frames(nominal, data);
  Chain chain = nominal;
  bool base_is_found = false;  // the chain's own, by the first rows that stand on it
  for (int mounting = -1; mounting < static_cast<int>(nominal.mountings.size()); ++mounting) {
    const std::vector<int> rows = rows_of_mounting(data, mounting);
    if (rows.empty()) continue;
    Chain alone = with_mounting(chain, mounting);
    PoseSet seen = select(data, rows);
    seen.mounting.clear();
    KINFER_TRY(found, estimate_frames(alone, seen));
    RobotMounting* const mounted = mounting < 0 ? nullptr : &chain.mountings[mounting];
    if (mounted && mounted->base)
      mounted->base = found.base;
    else if (!std::exchange(base_is_found, true))
      chain.base = found.base;
    (mounted ? mounted->tool : chain.tool) = found.tool;
  }
  return refine_frames(with_initial_fixtures(chain, data), data, frame_parameters(chain, data));
}

}  // namespace kinfer::calibrate
