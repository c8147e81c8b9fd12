// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/pair_fit.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "kinfer/base/expect.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

constexpr std::size_t heading_windows = 8;             // of equal length, within which the heading is taken as constant
constexpr int heading_starts = 24;                     // around the circle
constexpr int whitening_passes = 2;                    // passes weighted by the residual's covariance
constexpr double rows_per_independent_sample = 300.0;  // rows: orientation errors vary slowly, neighbours are redundant

using Vec2 = Eigen::Vector2d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Mat7 = Eigen::Matrix<double, 7, 7>;
using Row7 = Eigen::Matrix<double, 3, 7>;

/// [K, R, f]: specific force at a point of the segment in the world is this times (lever arm, bias, 1).
Row7 point_jacobian(const SegmentMotion& m, std::size_t row, double gravity) {
  const Mat3 angular_velocity = skew(m.angular_velocity[row]);
  Row7 jacobian;
  jacobian << (skew(m.angular_acceleration[row]) + angular_velocity * angular_velocity) * m.rotation[row],
      m.rotation[row], m.acceleration[row] + gravity * Vec3::UnitZ();
  return jacobian;
}

/// Rotation E of the second segment's world frame relative to the first's, see PairFit.
struct WorldRotation {
  LinearHeading heading;
  Vec2 tilt;

  Mat3 at(double time) const { return exp_so3({tilt.x(), tilt.y(), 0.0}) * rot_z(heading.at(time)); }
};

constexpr int rate_parts = 10;  // of the relative angular velocity: the first sensor's, and one per entry of E
using RateMoments = Eigen::Matrix<double, 3 * rate_parts, 3 * rate_parts>;

/// Sums over the rows of one window, within which E is taken as constant. With u and v of the two segments,
/// Σ uᵀ E v = Σ E(i, j) force(i, j). The relative angular velocity in the first sensor is likewise linear in the
/// entries of E, and its mean square a sum of these moments.
struct Window {
  std::array<std::array<Mat7, 3>, 3> force{};
  RateMoments angular_velocity = RateMoments::Zero();
  double time = 0.0, share = 0.0;
};

double determinant(const Mat3& m) {
  return m.col(0).dot(m.col(1).cross(m.col(2)));
}

/// ½ log det of the mean square plus the floor's [nats].
double code_length(const Mat3& mean_square, double floor) {
  return 0.5 * std::log(determinant(mean_square + floor * floor * Mat3::Identity()));
}

class PairProblem {
 public:
  PairProblem(const RecordedMotion& motion, std::size_t first, std::size_t second, const std::vector<std::size_t>& rows,
              const PairFitOptions& options)
      : motion_(motion), a_(motion.segments[first]), b_(motion.segments[second]), rows_(rows), options_(options) {
    begin_ = motion.time[rows.front()];
    end_ = motion.time[rows.back()];
    for (Window& window : windows_)
      for (auto& row : window.force) row.fill(Mat7::Zero());
    for (const std::size_t row : rows) add(row);
    for (Window& window : windows_)
      if (window.share > 0.0) window.time /= window.share;
  }

  WorldRotation world_rotation(double angle, double drift, const Vec2& tilt) const {
    return {{angle, drift, 0.5 * (begin_ + end_)}, tilt};
  }

  /// Code length per row [nats] plus the prior of E; the residual's covariance is taken as isotropic.
  double cost(const WorldRotation& world_rotation) const {
    const Normal normal = normal_equations(world_rotation);
    const auto x = solve_spd(normal.matrix, -normal.right);
    const double square = normal.square + (x ? x->dot(normal.right) : 0.0);
    const double noise = options_.acceleration_floor * options_.acceleration_floor;
    const double drift_ratio = world_rotation.heading.drift / options_.drift_sd;
    const double heading_ratio =
        options_.headings_from_magnetometers
            ? std::remainder(world_rotation.heading.angle, 2.0 * std::numbers::pi) / options_.heading_sd
            : 0.0;
    const double tilt_ratio_squared = world_rotation.tilt.squaredNorm() / (options_.tilt_sd * options_.tilt_sd);
    const double independent_samples = static_cast<double>(rows_.size()) / rows_per_independent_sample;
    return 1.5 * std::log(std::max(0.0, square) / 3.0 + noise) +
           code_length(mean_square_rate(world_rotation), options_.rate_floor) +
           0.5 * (drift_ratio * drift_ratio + heading_ratio * heading_ratio + tilt_ratio_squared) / independent_samples;
  }

  /// Lever arms, biases and residual at the fit's E, the residual weighted by `weight` (in the first sensor).
  void solve(PairFit& fit, const Mat3& weight) const {
    MatrixXd matrix = MatrixXd::Zero(12, 12);
    VectorXd right = VectorXd::Zero(12);
    matrix.diagonal() = prior();
    for (const std::size_t row : rows_) {
      const Eigen::Matrix<double, 3, 13> k = difference_jacobian({fit.heading, fit.tilt}, row);
      const Eigen::Matrix<double, 3, 13> weighted = weight * k;
      matrix.noalias() += k.leftCols<12>().transpose() * weighted.leftCols<12>() / count();
      right.noalias() += weighted.leftCols<12>().transpose() * k.col(12) / count();
    }
    const auto solution = solve_spd(matrix, -right);
    const VectorXd x = solution ? *solution : VectorXd::Zero(12);
    fit.point_in_first = x.head<3>();
    fit.bias_of_first = x.segment<3>(3);
    fit.point_in_second = x.segment<3>(6);
    fit.bias_of_second = x.tail<3>();
    fit.acceleration.setZero();
    for (const std::size_t row : rows_) {
      const Eigen::Matrix<double, 3, 13> k = difference_jacobian({fit.heading, fit.tilt}, row);
      const Vec3 residual = k.leftCols<12>() * x + k.col(12);
      fit.acceleration += residual * residual.transpose() / count();
    }
  }

  Mat3 mean_square_rate(const WorldRotation& world_rotation) const {
    Mat3 sum = Mat3::Zero();
    for (const Window& window : windows_) {
      Eigen::Matrix<double, rate_parts, 1> factor;
      factor << 1.0, world_rotation.at(window.time).reshaped<Eigen::RowMajor>();
      Eigen::Matrix<double, 3, 3 * rate_parts> half = Eigen::Matrix<double, 3, 3 * rate_parts>::Zero();
      for (int i = 0; i < rate_parts; ++i) half += factor[i] * window.angular_velocity.middleRows<3>(3 * i);
      for (int i = 0; i < rate_parts; ++i) sum += factor[i] * half.middleCols<3>(3 * i);
    }
    return sum;
  }

 private:
  struct Normal {
    MatrixXd matrix;
    VectorXd right;
    double square = 0.0;  // of the difference at zero lever arms and biases
  };

  double count() const { return static_cast<double>(rows_.size()); }

  /// Diagonal prior of the normal equations of a mean square, for a residual at its floor.
  Eigen::Matrix<double, 12, 1> prior() const {
    const double noise = options_.acceleration_floor * options_.acceleration_floor;
    const auto of = [&](double sd) { return noise / (sd * sd); };
    Eigen::Matrix<double, 12, 1> diagonal;
    diagonal << Vec3::Constant(of(options_.lever_sd)), Vec3::Constant(of(options_.bias_sd)),
        Vec3::Constant(of(options_.lever_sd)), Vec3::Constant(of(options_.bias_sd));
    return diagonal;
  }

  std::size_t window_of(std::size_t row) const {
    const double share = (motion_.time[row] - begin_) / std::max(end_ - begin_, 1e-9);
    return std::min(heading_windows - 1, static_cast<std::size_t>(share * static_cast<double>(heading_windows)));
  }

  void add(std::size_t row) {
    Window& window = windows_[window_of(row)];
    const double n = count();
    const Row7 u = point_jacobian(a_, row, motion_.gravity), v = point_jacobian(b_, row, motion_.gravity);
    of_first_ += u.transpose() * u / n;
    of_second_ += v.transpose() * v / n;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) window.force[i][j].noalias() += u.row(i).transpose() * v.row(j) / n;
    const Mat3 first_R_world = a_.rotation[row].transpose();
    Eigen::Matrix<double, 3, rate_parts> parts;
    parts.col(0) = -first_R_world * a_.angular_velocity[row];
    for (int i = 0; i < 3; ++i)
      parts.middleCols<3>(1 + 3 * i) = first_R_world.col(i) * b_.angular_velocity[row].transpose();
    window.angular_velocity.noalias() += parts.reshaped() * parts.reshaped().transpose() / n;
    window.time += motion_.time[row] / n;
    window.share += 1.0 / n;
  }

  Normal normal_equations(const WorldRotation& world_rotation) const {
    Mat7 mixed = Mat7::Zero();
    for (const Window& window : windows_) {
      const Mat3 e = world_rotation.at(window.time);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) mixed += e(i, j) * window.force[i][j];
    }
    Normal normal{MatrixXd(12, 12), VectorXd(12)};
    normal.matrix << of_first_.topLeftCorner<6, 6>(), -mixed.topLeftCorner<6, 6>(),
        -mixed.topLeftCorner<6, 6>().transpose(), of_second_.topLeftCorner<6, 6>();
    normal.matrix.diagonal() += prior();
    normal.right << of_first_.block<6, 1>(0, 6) - mixed.block<6, 1>(0, 6),
        of_second_.block<6, 1>(0, 6) - mixed.block<1, 6>(6, 0).transpose();
    normal.square = of_first_(6, 6) + of_second_(6, 6) - 2.0 * mixed(6, 6);
    return normal;
  }

  /// Difference of the specific forces, second minus first, in the first sensor: this times (lever arms, biases, 1).
  Eigen::Matrix<double, 3, 13> difference_jacobian(const WorldRotation& world_rotation, std::size_t row) const {
    const Mat3 first_R_world = a_.rotation[row].transpose();
    const Row7 u = first_R_world * point_jacobian(a_, row, motion_.gravity),
               v = first_R_world * world_rotation.at(motion_.time[row]) * point_jacobian(b_, row, motion_.gravity);
    Eigen::Matrix<double, 3, 13> k;
    k << -u.leftCols<6>(), v.leftCols<6>(), v.col(6) - u.col(6);
    return k;
  }

  const RecordedMotion& motion_;
  const SegmentMotion &a_, &b_;
  const std::vector<std::size_t>& rows_;
  const PairFitOptions& options_;
  double begin_ = 0.0, end_ = 0.0;
  Mat7 of_first_ = Mat7::Zero(), of_second_ = Mat7::Zero();
  std::array<Window, heading_windows> windows_;
};

/// Coarse grid of headings, then pattern search in angle, drift and tilt with halved steps.
WorldRotation search_world_rotation(const PairProblem& problem) {
  constexpr double coarse = 2.0 * std::numbers::pi / heading_starts, min_step = 1e-4;
  WorldRotation best = problem.world_rotation(0.0, 0.0, Vec2::Zero());
  double least = problem.cost(best);
  const auto try_rotation = [&](double angle, double drift, const Vec2& tilt) {
    const WorldRotation world_rotation = problem.world_rotation(angle, drift, tilt);
    const double cost = problem.cost(world_rotation);
    if (!(cost < least)) return false;
    best = world_rotation;
    least = cost;
    return true;
  };
  for (int k = 1; k < heading_starts; ++k) try_rotation(k * coarse, 0.0, Vec2::Zero());
  for (double step = 0.5 * coarse; step > min_step;) {
    const double drift_step = 0.01 * step, tilt_step = 0.1 * step;  // [rad/s] for a log of minutes; [rad]
    const auto heading = best.heading;
    const Vec2 tilt = best.tilt;
    const auto try_tilt = [&](const Vec2& by) {
      return try_rotation(heading.angle, heading.drift, tilt + tilt_step * by);
    };
    const bool better = try_rotation(heading.angle + step, heading.drift, tilt) ||
                        try_rotation(heading.angle - step, heading.drift, tilt) ||
                        try_rotation(heading.angle, heading.drift + drift_step, tilt) ||
                        try_rotation(heading.angle, heading.drift - drift_step, tilt) || try_tilt(Vec2::UnitX()) ||
                        try_tilt(-Vec2::UnitX()) || try_tilt(Vec2::UnitY()) || try_tilt(-Vec2::UnitY());
    if (!better) step *= 0.5;
  }
  return best;
}

/// Inverse of the mean square plus the floor's, scaled to the identity if isotropic.
Mat3 whitening(const Mat3& mean_square, double floor) {
  const auto inverse = invert_spd(mean_square + floor * floor * Mat3::Identity());
  KINFER_EXPECT(inverse, "a mean square plus a floor is positive definite");
  return 3.0 / inverse->trace() * *inverse;
}

}  // namespace

double PairFit::off_axis_rate() const {
  const VectorXd squares = symmetric_eigen(angular_velocity).values;
  return std::sqrt(std::max(0.0, squares[0] + squares[1]));
}

PairFit fit_pair(const RecordedMotion& motion, std::size_t first, std::size_t second,
                 const std::vector<std::size_t>& rows, const PairFitOptions& options) {
  KINFER_EXPECT(rows.size() >= 50, "{} rows", rows.size());
  const PairProblem problem(motion, first, second, rows, options);
  const WorldRotation world_rotation = search_world_rotation(problem);
  PairFit fit{.first = first, .second = second, .heading = world_rotation.heading, .tilt = world_rotation.tilt};
  fit.angular_velocity = problem.mean_square_rate(world_rotation);
  problem.solve(fit, Mat3::Identity());
  for (int k = 0; k < whitening_passes; ++k)
    problem.solve(fit, whitening(fit.acceleration, options.acceleration_floor));
  fit.distance =
      code_length(fit.acceleration, options.acceleration_floor) + code_length(fit.angular_velocity, options.rate_floor);
  return fit;
}

}  // namespace kinfer::identify
