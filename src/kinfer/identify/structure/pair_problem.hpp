// SPDX-License-Identifier: Apache-2.0
// The least-squares problem of a pair of segments: the common point, the accelerometer biases and the rotation between
// the two world frames (see pair_fit.hpp), from sums over the rows.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "kinfer/inertial/headings.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer::identify {

struct PairFit {
  std::size_t first = 0, second = 0;                                   ///< indices of segments, first < second
  LinearHeading heading{};                                             ///< of second's world frame in first's
  Eigen::Vector2d tilt{0.0, 0.0};                                      ///< [rad] likewise, about horizontal axes
  Vec3 point_in_first = Vec3::Zero(), point_in_second = Vec3::Zero();  ///< [m] the common point, as far as observable
  Vec3 bias_of_first = Vec3::Zero(), bias_of_second = Vec3::Zero();    ///< [m/s²] negative accelerometer biases
  Mat3 acceleration = Mat3::Zero();      ///< [(m/s²)²] mean square of the residual, in the first sensor
  Mat3 angular_velocity = Mat3::Zero();  ///< [(rad/s)²] mean square of the relative angular velocity, likewise
  double distance = 0.0;                 ///< [nats] code length per row

  double residual() const { return std::sqrt(acceleration.trace()); }  ///< [m/s²] rms, prismatic motion included
  double relative_rate() const { return std::sqrt(angular_velocity.trace()); }  ///< [rad/s] rms
  double off_axis_rate() const;  ///< [rad/s] rms across the principal direction
};

/// Where the headings of a pair come from.
enum class HeadingReference { arbitrary, magnetometers };

inline constexpr std::size_t heading_windows = 8;  // of equal length, within which the drift is constant

using Vec2 = Eigen::Vector2d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Mat7 = Eigen::Matrix<double, 7, 7>;
using Row7 = Eigen::Matrix<double, 3, 7>;

/// Rotation E of the second segment's world frame relative to the first's, see PairFit.
struct WorldRotation {
  LinearHeading heading;
  Vec2 tilt;

  Mat3 at(double time) const { return exp_so3({tilt.x(), tilt.y(), 0.0}) * rot_z(heading.at(time)); }
};

inline constexpr int rate_parts = 10;  // of the relative angular velocity: the first sensor's, and one per entry of E
using RateMoments = Eigen::Matrix<double, 3 * rate_parts, 3 * rate_parts>;

/// Sums over the rows of one window, within which E is taken as constant. With u and v of the two segments,
/// Σ uᵀ E v = Σ E(i, j) force(i, j). The relative angular velocity in the first sensor is likewise linear in the
/// entries of E, and its mean square a sum of these moments.
struct HeadingWindow {
  std::array<std::array<Mat7, 3>, 3> force{};
  RateMoments angular_velocity = RateMoments::Zero();
  double time = 0.0, share = 0.0;
};

/// ½ log det of the mean square plus the floor's [nats].
double code_length(const Mat3& mean_square, double floor);

class PairProblem {
 public:
  /// `rows`: see fit_pair; all arguments must outlive the problem.
  PairProblem(const RecordedMotion& motion, std::size_t first, std::size_t second, const std::vector<std::size_t>& rows,
              HeadingReference headings);

  /// `offsets` [rad]: of the heading in each part, one per part.
  WorldRotation world_rotation(double angle, double drift, const Vec2& tilt, const std::vector<double>& offsets) const;

  /// Parts of the rows between the gaps of the two sensors, within which no heading restarts: the number of their rows.
  const std::vector<std::size_t>& parts() const { return parts_; }

  /// What the windows of a part contribute to the cost at some E.
  struct PartSums {
    Mat7 force = Mat7::Zero();             ///< Σ uᵀ E v
    Mat3 angular_velocity = Mat3::Zero();  ///< as mean_square_rate
  };
  PartSums sums_of(std::size_t part, const WorldRotation& world_rotation) const;
  std::vector<PartSums> sums_of_parts(const WorldRotation& world_rotation) const;

  /// Code length per row [nats] plus the prior of E; the residual's covariance is taken as isotropic. `sums`: those at
  /// that E.
  double cost(const std::vector<PartSums>& sums, const WorldRotation& world_rotation) const;

  /// Lever arms, biases and residual at the fit's E, the residual weighted by `weight` (in the first sensor).
  void solve(PairFit& fit, const Mat3& weight) const;

  /// [(rad/s)²] of the relative angular velocity, in the first sensor.
  Mat3 mean_square_rate(const WorldRotation& world_rotation) const;

 private:
  struct Normal {
    MatrixXd matrix;
    VectorXd right;
    double square = 0.0;  // of the difference at zero lever arms and biases
  };

  double count() const { return static_cast<double>(rows_.size()); }
  Eigen::Matrix<double, 12, 1> prior() const;
  void make_windows();
  void add(HeadingWindow& window, std::size_t row);
  double magnetic_cost(const WorldRotation& world_rotation) const;
  Normal normal_equations(const Mat7& mixed) const;
  Eigen::Matrix<double, 3, 13> difference_jacobian(const WorldRotation& world_rotation, std::size_t row) const;

  const RecordedMotion& motion_;
  const SegmentMotion &a_, &b_;
  const std::vector<std::size_t>& rows_;
  HeadingReference headings_;
  double begin_ = 0.0, end_ = 0.0;
  Mat7 of_first_ = Mat7::Zero(), of_second_ = Mat7::Zero();
  std::vector<HeadingWindow> windows_;
  std::vector<std::size_t> parts_;
  std::vector<std::size_t> first_window_;  // of each part, and the number of windows
  std::vector<double> part_begin_;         // [s]
};

}  // namespace kinfer::identify
