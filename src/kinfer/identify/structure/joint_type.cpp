// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/joint_type.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/structure/thresholds.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

/// Relative motion of the child in the parent at the evaluated rows.
struct RelativeMotion {
  std::vector<Mat3> rotation;          // parent_R_child
  std::vector<Vec3> angular_velocity;  // [rad/s] in the parent
  double rms_rate = 0.0;               // [rad/s] rms of the faster sensor
};

std::vector<std::size_t> evaluated_rows(const RecordedMotion& motion) {
  std::vector<std::size_t> rows;
  const std::size_t stride = std::max<std::size_t>(1, (motion.rows() - motion.first_motion_row) / joint_type_rows);
  for (std::size_t row = motion.first_motion_row; row < motion.rows(); row += stride)
    if (motion.usable[row]) rows.push_back(row);
  return rows;
}

double rms(const std::vector<Vec3>& vectors) {
  double sum = 0.0;
  for (const Vec3& v : vectors) sum += v.squaredNorm();
  return vectors.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(vectors.size()));
}

RelativeMotion relative_motion(const SegmentMotion& parent, const SegmentMotion& child,
                               const std::vector<std::size_t>& rows) {
  RelativeMotion relative;
  std::vector<Vec3> of_parent, of_child;
  for (const std::size_t row : rows) {
    const Mat3 to_parent = parent.rotation[row].transpose();
    relative.rotation.push_back(to_parent * child.rotation[row]);
    relative.angular_velocity.push_back(to_parent * (child.angular_velocity[row] - parent.angular_velocity[row]));
    of_parent.push_back(parent.angular_velocity[row]);
    of_child.push_back(child.angular_velocity[row]);
  }
  relative.rms_rate = std::max(rms(of_parent), rms(of_child));
  return relative;
}

/// Eigen-decomposition of the vectors' second moment: smallest first.
template <class Make>
SymmetricEigen second_moment(std::size_t count, const Make& vector) {
  Mat3 sum = Mat3::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 v = vector(i);
    sum += v * v.transpose() / static_cast<double>(count);
  }
  return symmetric_eigen(sum);
}

std::array<double, 3> largest_first(const VectorXd& squares) {
  const auto root = [&](Eigen::Index i) { return std::sqrt(std::max(0.0, squares[i])); };
  return {root(2), root(1), root(0)};
}

/// Two axes, one fixed in each segment, that best span the relative angular velocity: alternately each is the direction
/// that minimises ω · (e₁ × R e₂) with the other fixed.
struct TwoAxes {
  Vec3 in_parent, in_child;
  double off_plane = 0.0;  // [rad/s] rms
};

TwoAxes two_axes(const RelativeMotion& relative, Vec3 in_parent) {
  constexpr int rounds = 30;
  const std::size_t n = relative.angular_velocity.size();
  Vec3 in_child = Vec3::UnitZ();
  for (int round = 0; round < rounds; ++round) {
    in_child = second_moment(n, [&](std::size_t i) {
                 return Vec3(relative.rotation[i].transpose() * relative.angular_velocity[i].cross(in_parent));
               }).vectors.col(0);
    in_parent = second_moment(n, [&](std::size_t i) {
                  return Vec3((relative.rotation[i] * in_child).cross(relative.angular_velocity[i]));
                }).vectors.col(0);
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 normal = in_parent.cross(relative.rotation[i] * in_child);
    const double off = relative.angular_velocity[i].dot(normal) / std::max(normal.norm(), 0.1);
    sum += off * off / static_cast<double>(n);
  }
  return {in_parent, in_child, std::sqrt(sum)};
}

TwoAxes best_two_axes(const RelativeMotion& relative, const Mat3& starts) {
  TwoAxes best = two_axes(relative, starts.col(0));
  for (int k = 1; k < 3; ++k)
    if (const TwoAxes other = two_axes(relative, starts.col(k)); other.off_plane < best.off_plane) best = other;
  return best;
}

/// Whether a component of this rms has a shorter code at its own size, direction parameters included, than at the size
/// of the errors.
bool is_motion(double size, double error, double independent_samples) {
  constexpr double parameters = 2.0;
  if (size <= error) return false;
  const double ratio = size * size / (error * error);
  return independent_samples * (ratio - 1.0 - std::log(ratio)) > parameters * std::log(independent_samples + 1.0);
}

std::vector<double> along(const std::vector<Vec3>& vectors, const Vec3& direction) {
  std::vector<double> series;
  for (const Vec3& v : vectors) series.push_back(direction.dot(v));
  return series;
}

/// Acceleration of the child minus that of the parent, in the parent: translation, lever-arm terms not removed.
std::vector<Vec3> acceleration_differences(const SegmentMotion& parent, const SegmentMotion& child,
                                           const std::vector<std::size_t>& rows) {
  std::vector<Vec3> differences;
  for (const std::size_t row : rows)
    differences.push_back(parent.rotation[row].transpose() * (child.acceleration[row] - parent.acceleration[row]));
  return differences;
}

struct PairMotion {
  RelativeMotion relative;
  SymmetricEigen rates, accelerations;  // mean squares, least first
  JointTypeEvidence evidence;
};

PairMotion pair_motion(const RecordedMotion& motion, const SegmentTree& tree, std::size_t child,
                       const std::vector<std::size_t>& rows) {
  const std::size_t parent = *tree.parent[child];
  const PairFit& pair = tree.pair(parent, child);
  PairMotion j{relative_motion(motion.segments[parent], motion.segments[child], rows), {}, {}, {}};
  j.rates = second_moment(rows.size(), [&](std::size_t i) { return j.relative.angular_velocity[i]; });
  j.accelerations = symmetric_eigen(pair.acceleration);
  j.evidence.rates = largest_first(j.rates.values);
  j.evidence.accelerations = largest_first(j.accelerations.values);
  j.evidence.axis_in_parent = j.rates.vectors.col(2);
  j.evidence.axis_in_child = second_moment(rows.size(), [&](std::size_t i) {
                               return Vec3(j.relative.rotation[i].transpose() * j.relative.angular_velocity[i]);
                             }).vectors.col(2);
  return j;
}

/// Errors as a share of the sensors' angular velocity: median over the joints of the smallest component, since few
/// joints of a machine rotate in all directions.
double error_share(const std::vector<PairMotion>& joints) {
  std::vector<double> shares;
  for (const PairMotion& j : joints)
    shares.push_back(j.evidence.rates[2] / std::max(j.relative.rms_rate, relative_rate_noise));
  std::ranges::sort(shares);
  return std::clamp(shares[shares.size() / 2], min_rate_error_share, max_rate_error_share);
}

EstimatedJointType rotational_type(PairMotion& j) {
  JointTypeEvidence& e = j.evidence;
  const auto samples = [&](Eigen::Index k) {
    return effective_samples(along(j.relative.angular_velocity, j.rates.vectors.col(k)));
  };
  if (!is_motion(e.rates[0], e.rate_error, samples(2))) return EstimatedJointType::rigid;
  if (!is_motion(e.rates[1], e.rate_error, samples(1))) return EstimatedJointType::revolute;
  const TwoAxes axes = best_two_axes(j.relative, j.rates.vectors);
  e.off_plane_rate = axes.off_plane;
  // Two axes leave most of the third component.
  const bool has_third_component = e.rates[2] > e.rate_error && axes.off_plane > 0.5 * e.rates[2];
  if (has_third_component || is_motion(axes.off_plane, e.rate_error, samples(0))) return EstimatedJointType::spherical;
  e.axis_in_parent = axes.in_parent;
  e.axis_in_child = axes.in_child;
  return EstimatedJointType::universal;
}

}  // namespace

std::vector<JointTypeEvidence> joint_types(const RecordedMotion& motion, const SegmentTree& tree) {
  const std::vector<std::size_t> rows = evaluated_rows(motion);
  std::vector<PairMotion> joints;
  for (const std::size_t child : tree.order)
    if (tree.parent[child]) joints.push_back(pair_motion(motion, tree, child, rows));
  if (joints.empty()) return {};
  const double share = error_share(joints);
  std::vector<JointTypeEvidence> result;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    PairMotion& j = joints[i];
    const std::size_t child = tree.order[i + 1], parent = *tree.parent[child];
    const auto error = [&](double part) {
      return motion_significance * std::hypot(relative_rate_noise, part * j.relative.rms_rate);
    };
    j.evidence.rate_error = error(share);
    // A single joint has no others that tell errors from motion: what all its components have may be motion.
    if (joints.size() == 1 && j.evidence.rates[0] <= j.evidence.rate_error)
      j.evidence.rate_error = error(min_rate_error_share);
    j.evidence.type = rotational_type(j);
    const auto& a = j.evidence.accelerations;
    const auto differences = acceleration_differences(motion.segments[parent], motion.segments[child], rows);
    const double slide_error = std::max(rigid_acceleration_noise, prismatic_dominance * a[1]);
    const Vec3 prismatic_axis =
        second_moment(rows.size(), [&](std::size_t k) { return differences[k]; }).vectors.col(2);
    if (j.evidence.type == EstimatedJointType::rigid &&
        is_motion(a[0], slide_error, effective_samples(along(differences, prismatic_axis)))) {
      j.evidence.type = EstimatedJointType::prismatic;
      j.evidence.axis_in_parent = prismatic_axis;
      j.evidence.axis_in_child = j.relative.rotation.front().transpose() * prismatic_axis;
    }
    result.push_back(j.evidence);
  }
  return result;
}

}  // namespace kinfer::identify
