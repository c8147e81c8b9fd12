#include "kinfer/identify/pair_fit.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "kinfer/base/expect.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

constexpr std::size_t windows = 8;             // of equal length, within which the heading counts as constant
constexpr int heading_starts = 24;             // around the circle
constexpr int whitenings = 2;                  // passes in which the residual's covariance weighs it
constexpr double samples_of_one_fact = 300.0;  // rows: orientations err slowly, so few rows tell anything new

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Mat7 = Eigen::Matrix<double, 7, 7>;
using Row7 = Eigen::Matrix<double, 3, 7>;

/// [K R, R, a]: acceleration of a point of the segment in the ground is this times (lever, bias, 1).
Row7 point_effect(const SegmentMotion& m, std::size_t row) {
  const Mat3 rate = skew(m.rate[row]);
  Row7 effect;
  effect << (skew(m.rate_change[row]) + rate * rate) * m.rotation[row], m.rotation[row], m.acceleration[row];
  return effect;
}

/// Sums over the rows of one window from which any heading's normal equations follow: with u and v of the two segments,
/// Σ uᵀ Rz(ψ) v = upright + cos ψ · level + sin ψ · turned. Likewise the relative rate in the first sensor is
/// constant + cos ψ · level + sin ψ · turned, and its mean square is a sum of these moments.
struct Window {
  Mat7 upright = Mat7::Zero(), level = Mat7::Zero(), turned = Mat7::Zero();
  std::array<std::array<Mat3, 3>, 3> rate{};
  double time = 0.0, share = 0.0;
};

Vec3 level_part(const Vec3& v) {
  return {v.x(), v.y(), 0.0};
}
Vec3 turned_part(const Vec3& v) {
  return {-v.y(), v.x(), 0.0};
}

double determinant(const Mat3& m) {
  return m.col(0).dot(m.col(1).cross(m.col(2)));
}

/// ½ log det of the mean square, what is below the floor not counted [nats].
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
      for (auto& row : window.rate) row.fill(Mat3::Zero());
    for (const std::size_t row : rows) add(row);
    for (Window& window : windows_)
      if (window.share > 0.0) window.time /= window.share;
  }

  HeadingLine line(double angle, double drift) const { return {angle, drift, 0.5 * (begin_ + end_)}; }

  /// Code length of a row [nats] with the heading's own, the residual's covariance taken as isotropic.
  double cost(const HeadingLine& heading) const {
    const Normal normal = normal_equations(heading);
    const auto x = solve_positive(normal.matrix, -normal.right);
    const double square = normal.square + (x ? x->dot(normal.right) : 0.0);
    const double noise = options_.acceleration_floor * options_.acceleration_floor;
    const double wander = heading.drift / options_.drift_sd;
    const double wrong =
        options_.headings_known ? std::remainder(heading.angle, 2.0 * std::numbers::pi) / options_.heading_sd : 0.0;
    const double facts = static_cast<double>(rows_.size()) / samples_of_one_fact;
    return 1.5 * std::log(std::max(0.0, square) / 3.0 + noise) +
           code_length(mean_square_rate(heading), options_.rate_floor) +
           0.5 * (wander * wander + wrong * wrong) / facts;
  }

  /// Levers, biases and residual at the heading, the residual weighted by `weight` (in the first sensor).
  void solve(PairFit& fit, const Mat3& weight) const {
    MatrixXd matrix = MatrixXd::Zero(12, 12);
    VectorXd right = VectorXd::Zero(12);
    matrix.diagonal() = prior();
    for (const std::size_t row : rows_) {
      const Eigen::Matrix<double, 3, 13> k = difference_effect(fit.heading, row);
      const Eigen::Matrix<double, 3, 13> weighted = weight * k;
      matrix.noalias() += k.leftCols<12>().transpose() * weighted.leftCols<12>() / count();
      right.noalias() += weighted.leftCols<12>().transpose() * k.col(12) / count();
    }
    const auto solution = solve_positive(matrix, -right);
    const VectorXd x = solution ? *solution : VectorXd::Zero(12);
    fit.point_in_first = x.head<3>();
    fit.bias_of_first = x.segment<3>(3);
    fit.point_in_second = x.segment<3>(6);
    fit.bias_of_second = x.tail<3>();
    fit.acceleration.setZero();
    for (const std::size_t row : rows_) {
      const Eigen::Matrix<double, 3, 13> k = difference_effect(fit.heading, row);
      const Vec3 residual = k.leftCols<12>() * x + k.col(12);
      fit.acceleration += residual * residual.transpose() / count();
    }
  }

  Mat3 mean_square_rate(const HeadingLine& heading) const {
    Mat3 sum = Mat3::Zero();
    for (const Window& window : windows_) {
      const double angle = heading.at(window.time);
      const std::array factors{1.0, std::cos(angle), std::sin(angle)};
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) sum += factors[i] * factors[j] * window.rate[i][j];
    }
    return sum;
  }

 private:
  struct Normal {
    MatrixXd matrix;
    VectorXd right;
    double square = 0.0;  // of the difference without any lever
  };

  double count() const { return static_cast<double>(rows_.size()); }

  /// Of the normal equations of a mean square; as if the residual were at its floor and rows told little each.
  Eigen::Matrix<double, 12, 1> prior() const {
    const double noise = options_.acceleration_floor * options_.acceleration_floor;
    const auto of = [&](double sd) { return noise / (sd * sd); };
    Eigen::Matrix<double, 12, 1> diagonal;
    diagonal << Vec3::Constant(of(options_.longest_lever)), Vec3::Constant(of(options_.largest_bias)),
        Vec3::Constant(of(options_.longest_lever)), Vec3::Constant(of(options_.largest_bias));
    return diagonal;
  }

  std::size_t window_of(std::size_t row) const {
    const double share = (motion_.time[row] - begin_) / std::max(end_ - begin_, 1e-9);
    return std::min(windows - 1, static_cast<std::size_t>(share * static_cast<double>(windows)));
  }

  void add(std::size_t row) {
    Window& window = windows_[window_of(row)];
    const double n = count();
    const Row7 u = point_effect(a_, row), v = point_effect(b_, row);
    of_first_ += u.transpose() * u / n;
    of_second_ += v.transpose() * v / n;
    window.upright.noalias() += u.row(2).transpose() * v.row(2) / n;
    window.level.noalias() += u.topRows<2>().transpose() * v.topRows<2>() / n;
    window.turned.noalias() += (u.row(1).transpose() * v.row(0) - u.row(0).transpose() * v.row(1)) / n;
    const Mat3 to_first = a_.rotation[row].transpose();
    const Vec3 rate = b_.rate[row];
    const std::array<Vec3, 3> parts{to_first * (Vec3(0.0, 0.0, rate.z()) - a_.rate[row]), to_first * level_part(rate),
                                    to_first * turned_part(rate)};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) window.rate[i][j] += parts[i] * parts[j].transpose() / n;
    window.time += motion_.time[row] / n;
    window.share += 1.0 / n;
  }

  Normal normal_equations(const HeadingLine& heading) const {
    Mat7 mixed = Mat7::Zero();
    for (const Window& window : windows_) {
      const double angle = heading.at(window.time);
      mixed += window.upright + std::cos(angle) * window.level + std::sin(angle) * window.turned;
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

  /// Difference of the accelerations, second less first, in the first sensor: this times (levers and biases, 1).
  Eigen::Matrix<double, 3, 13> difference_effect(const HeadingLine& heading, std::size_t row) const {
    const Mat3 to_first = a_.rotation[row].transpose(), turn = to_first * rot_z(heading.at(motion_.time[row]));
    const Row7 u = to_first * point_effect(a_, row), v = turn * point_effect(b_, row);
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
  std::array<Window, windows> windows_;
};

/// Best of a coarse circle of headings, then by halving steps in angle and drift.
HeadingLine best_heading(const PairProblem& problem) {
  constexpr double coarse = 2.0 * std::numbers::pi / heading_starts, finest = 1e-4;
  HeadingLine best = problem.line(0.0, 0.0);
  double least = problem.cost(best);
  const auto try_line = [&](double angle, double drift) {
    const HeadingLine line = problem.line(angle, drift);
    const double cost = problem.cost(line);
    if (!(cost < least)) return false;
    best = line;
    least = cost;
    return true;
  };
  for (int k = 1; k < heading_starts; ++k) try_line(k * coarse, 0.0);
  for (double step = 0.5 * coarse; step > finest;) {
    const double drift_step = 0.01 * step;  // [rad/s] of a log of minutes
    const HeadingLine at = best;
    const bool better = try_line(at.angle + step, at.drift) || try_line(at.angle - step, at.drift) ||
                        try_line(at.angle, at.drift + drift_step) || try_line(at.angle, at.drift - drift_step);
    if (!better) step *= 0.5;
  }
  return best;
}

/// Inverse of the mean square above its floor, scaled so that an isotropic one weighs 1.
Mat3 whitening(const Mat3& mean_square, double floor) {
  const auto inverse = inverse_positive(mean_square + floor * floor * Mat3::Identity());
  KINFER_EXPECT(inverse, "a mean square plus a floor is positive definite");
  return 3.0 / inverse->trace() * *inverse;
}

}  // namespace

double PairFit::off_axis_rate() const {
  const VectorXd squares = symmetric_eigen(rate).values;
  return std::sqrt(std::max(0.0, squares[0] + squares[1]));
}

PairFit fit_pair(const RecordedMotion& motion, std::size_t first, std::size_t second,
                 const std::vector<std::size_t>& rows, const PairFitOptions& options) {
  KINFER_EXPECT(rows.size() >= 50, "{} rows", rows.size());
  const PairProblem problem(motion, first, second, rows, options);
  PairFit fit{.first = first, .second = second, .heading = best_heading(problem)};
  fit.rate = problem.mean_square_rate(fit.heading);
  problem.solve(fit, Mat3::Identity());
  for (int k = 0; k < whitenings; ++k) problem.solve(fit, whitening(fit.acceleration, options.acceleration_floor));
  fit.distance = code_length(fit.acceleration, options.acceleration_floor) + code_length(fit.rate, options.rate_floor);
  return fit;
}

}  // namespace kinfer
