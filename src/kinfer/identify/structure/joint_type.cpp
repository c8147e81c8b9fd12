// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/joint_type.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/identify/structure/heading_drift.hpp"
#include "kinfer/identify/structure/slide_fit.hpp"
#include "kinfer/identify/structure/thresholds.hpp"
#include "kinfer/identify/structure/universal_axes.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

/// Relative motion of the child in the parent at the evaluated rows.
struct RelativeMotion {
  std::vector<Mat3> rotation;          // parent_R_child
  std::vector<Vec3> angular_velocity;  // [rad/s] in the parent
  double rms_rate = 0.0;               // [rad/s] rms of the faster sensor
  double rms_acceleration = 0.0;       // [m/s²] likewise
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
  std::vector<Vec3> of_parent, of_child, acceleration_of_parent, acceleration_of_child;
  for (const std::size_t row : rows) {
    const Mat3 to_parent = parent.rotation[row].transpose();
    relative.rotation.push_back(to_parent * child.rotation[row]);
    relative.angular_velocity.push_back(to_parent * (child.angular_velocity[row] - parent.angular_velocity[row]));
    of_parent.push_back(parent.angular_velocity[row]);
    of_child.push_back(child.angular_velocity[row]);
    acceleration_of_parent.push_back(parent.acceleration[row]);
    acceleration_of_child.push_back(child.acceleration[row]);
  }
  relative.rms_rate = std::max(rms(of_parent), rms(of_child));
  relative.rms_acceleration = std::max(rms(acceleration_of_parent), rms(acceleration_of_child));
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

struct PairMotion {
  RelativeMotion relative;
  std::vector<Mat3> rotation;  // parent_R_child without the drift of headings and their steps behind gaps
  SymmetricEigen rates;        // mean squares, least first
  RigidRates rigid;
  UniversalAxes two_axes;
  JointTypeEvidence evidence;
};

PairMotion pair_motion(const RecordedMotion& motion, const SegmentTree& tree, std::size_t child,
                       const std::vector<std::size_t>& rows) {
  const std::size_t parent = *tree.parent[child];
  const PairFit& pair = tree.pair(parent, child);
  PairMotion j{relative_motion(motion.segments[parent], motion.segments[child], rows), {}, {}, {}, {}, {}};
  j.rotation =
      without_heading_drift(motion, motion.segments[parent], motion.segments[child], rows, j.relative.rotation);
  j.rigid = rigid_rates(motion, motion.segments[parent], motion.segments[child]);
  j.rates = second_moment(rows.size(), [&](std::size_t i) { return j.relative.angular_velocity[i]; });
  j.evidence.rates = largest_first(j.rates.values);
  j.evidence.accelerations = largest_first(symmetric_eigen(pair.acceleration).values);
  j.evidence.axis_in_parent = j.rates.vectors.col(2);
  j.evidence.axis_in_child = second_moment(rows.size(), [&](std::size_t i) {
                               return Vec3(j.relative.rotation[i].transpose() * j.relative.angular_velocity[i]);
                             }).vectors.col(2);
  j.two_axes = universal_axes(j.rotation, j.rates.vectors);
  return j;
}

/// Deviation of rotations from a constant one (0) and from those about one axis (2), by the singular values σ of their
/// mean: mean ‖R e − mean‖² of the axes that fit best is 2 (1 − σ).
double mean_deviation(const std::vector<Mat3>& rotations, Eigen::Index of) {
  Mat3 mean = Mat3::Zero();
  for (const Mat3& rotation : rotations) mean += rotation / static_cast<double>(rotations.size());
  const VectorXd squares = symmetric_eigen(mean.transpose() * mean).values;  // σ², least first
  return std::sqrt(std::max(0.0, 2.0 * (1.0 - std::sqrt(std::max(0.0, squares[of])))));
}

/// What the motion leaves to each type.
MotionDeviations motion_deviations(const PairMotion& j) {
  return {.rotation = mean_deviation(j.rotation, 0),
          .axis = mean_deviation(j.rotation, 2),
          .plane = j.two_axes.deviation,
          .axes_angle = j.two_axes.angle,
          .rate_share =
              j.evidence.rates[0] / std::hypot(j.relative.rms_rate, relative_rate_noise / rigid_rate_share.median),
          .rates = j.rigid,
          .acceleration = j.evidence.accelerations[0],
          .acceleration_across = j.evidence.accelerations[1],
          .acceleration_level = j.relative.rms_acceleration};
}

}  // namespace

std::vector<JointTypeEvidence> joint_types(const RecordedMotion& motion, const SegmentTree& tree) {
  const std::vector<std::size_t> rows = evaluated_rows(motion);
  std::vector<PairMotion> joints;
  for (const std::size_t child : tree.order)
    if (tree.parent[child]) joints.push_back(pair_motion(motion, tree, child, rows));
  if (joints.empty()) return {};
  std::vector<MotionDeviations> deviations;
  for (const PairMotion& j : joints) deviations.push_back(motion_deviations(j));
  const std::vector<JointTypeProbabilities> probabilities = type_probabilities(deviations);
  std::vector<JointTypeEvidence> result;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    PairMotion& j = joints[i];
    const std::size_t child = tree.order[i + 1], parent = *tree.parent[child];
    j.evidence.probabilities = probabilities[i];
    j.evidence.type = most_probable(probabilities[i]);
    if (j.evidence.type == EstimatedJointType::universal) {
      j.evidence.axis_in_parent = j.two_axes.in_parent;
      j.evidence.axis_in_child = j.two_axes.in_child;
    }
    if (j.evidence.type == EstimatedJointType::prismatic) {
      j.evidence.axis_in_parent =
          fit_slide(motion, motion.segments[parent], motion.segments[child]).value_or(SlideFit{}).axis_in_parent;
      j.evidence.axis_in_child = j.relative.rotation.front().transpose() * j.evidence.axis_in_parent;
    }
    result.push_back(j.evidence);
  }
  return result;
}

}  // namespace kinfer::identify
