#include "kinfer/calibrate/frames_start.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "kinfer/calibrate/parameter_choice.hpp"
#include "kinfer/estimate/residuals.hpp"
#include "kinfer/geometry/fit.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

std::vector<Pose> base_to_flange(Chain chain, const PoseSet& data) {
  chain.base = Frame{};
  chain.tool = Frame{};
  return evaluate_poses(chain, {}, data, Derivative::no).pose;
}

Vec3 point_on_flange(const Chain& chain, const PointMeasurement& point) {
  const Pose tool = chain.tool.pose();
  return point.target < 0 ? tool.position : tool * chain.targets[point.target].xyz;
}

/// Base by rigid alignment of the measured points with where the chain has them.
Chain with_aligned_base(Chain chain, const PoseSet& data, const std::vector<Pose>& base_T_flange) {
  std::vector<Vec3> measured, predicted;
  for (const PointMeasurement& point : data.points) {
    measured.push_back(point.position);
    predicted.push_back(base_T_flange[point.row] * point_on_flange(chain, point));
  }
  chain.base = Frame::from_pose(align_points(measured, predicted));
  return chain;
}

/// Base and tool rotation from the measured orientations: between two poses the world sees the flange turn by the same
/// rotation vector as the chain, seen from the base.
Chain with_aligned_rotations(Chain chain, const PoseSet& data, const std::vector<Pose>& base_T_flange) {
  std::vector<Vec3> in_world, in_base;
  const auto& all = data.orientations;
  const std::size_t stride =
      std::max<std::size_t>(1, all.size() / 60);  // pairs enough; their number grows with the square
  for (std::size_t i = 0; i < all.size(); i += stride)
    for (std::size_t j = 0; j < i; j += stride) {
      const Mat3 seen = all[i].orientation.toRotationMatrix() * all[j].orientation.toRotationMatrix().transpose();
      const Mat3 made = base_T_flange[all[i].row].rotation * base_T_flange[all[j].row].rotation.transpose();
      const Vec3 seen_vector = log_so3(seen), made_vector = log_so3(made);
      if (seen_vector.norm() > 3.0 || made_vector.norm() > 3.0) continue;  // near half a turn the sign is arbitrary
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

/// Base and tool together, under a loss that wrong rows cannot pull; the noise level is the typical residual at the
/// start.
Chain refined(const Chain& start, const PoseSet& data, const ParameterSet& frames) {
  const auto floored_median = [](std::vector<double> errors, double floor) {
    return errors.empty() ? floor : std::max(floor, median(std::move(errors)));
  };
  constexpr int rounds = 4;  // the noise level falls with the residuals
  Chain chain = start;
  for (int i = 0; i < rounds; ++i) {
    Weights weights;
    weights.point_sd.assign(data.points.size(), Vec3::Constant(floored_median(point_errors(chain, data), 1e-9)));
    weights.orientation_sd.assign(data.orientations.size(), floored_median(orientation_errors(chain, data), 1e-9));
    LeastSquaresOptions options;
    options.loss = Loss::cauchy;
    const Chain from = chain;
    chain =
        unpack(frames, from, least_squares(pose_residuals(from, frames, data, weights), pack(frames, from), options).x);
  }
  return with_turns_folded(chain);
}

double typical_error(const Chain& chain, const PoseSet& data) {
  std::vector<double> errors = point_errors(chain, data);
  return errors.empty() ? 0.0 : median(std::move(errors));
}

}  // namespace

Result<Chain> with_frames_from_data(const Chain& nominal, const PoseSet& data) {
  std::set<int> rows;
  for (const PointMeasurement& point : data.points) rows.insert(point.row);
  if (rows.size() < 3)
    return error("the pose set measures {} positions; at least 3 are needed to find the base of the robot",
                 rows.size());
  const std::vector<Pose> base_T_flange = base_to_flange(nominal, data);
  ParameterSet frames = frame_parameters(nominal, data);
  for (Parameter& parameter : frames.parameters) parameter.prior_sd = std::numeric_limits<double>::infinity();

  std::vector<Chain> starts{with_aligned_base(nominal, data, base_T_flange)};
  if (nominal.tool.xyz.norm() > 0.0) {  // a file's tool may be of another set-up
    Chain bare = nominal;
    bare.tool.xyz.setZero();
    starts.push_back(with_aligned_base(bare, data, base_T_flange));
  }
  if (!data.orientations.empty())
    starts.push_back(
        with_solved_translations(with_aligned_rotations(nominal, data, base_T_flange), data, base_T_flange));

  std::optional<Chain> best;
  for (const Chain& start : starts) {
    const Chain candidate = refined(start, data, frames);
    if (!best || typical_error(candidate, data) < typical_error(*best, data)) best = candidate;
  }
  return *best;
}

}  // namespace kinfer
