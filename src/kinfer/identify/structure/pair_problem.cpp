// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/pair_problem.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/identify/structure/thresholds.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

/// [K, R, f]: specific force at a point of the segment in the world is this times (lever arm, bias, 1).
Row7 point_jacobian(const SegmentMotion& m, std::size_t row, double gravity) {
  const Mat3 angular_velocity = skew(m.angular_velocity[row]);
  Row7 jacobian;
  jacobian << (skew(m.angular_acceleration[row]) + angular_velocity * angular_velocity) * m.rotation[row],
      m.rotation[row], m.acceleration[row] + gravity * Vec3::UnitZ();
  return jacobian;
}

double determinant(const Mat3& m) {
  return m.col(0).dot(m.col(1).cross(m.col(2)));
}

}  // namespace

double code_length(const Mat3& mean_square, double floor) {
  return 0.5 * std::log(determinant(mean_square + floor * floor * Mat3::Identity()));
}

PairProblem::PairProblem(const RecordedMotion& motion, std::size_t first, std::size_t second,
                         const std::vector<std::size_t>& rows, HeadingReference headings)
    : motion_(motion), a_(motion.segments[first]), b_(motion.segments[second]), rows_(rows), headings_(headings) {
  begin_ = motion.time[rows.front()];
  end_ = motion.time[rows.back()];
  make_windows();
  for (HeadingWindow& window : windows_) window.time /= window.share;
}

WorldRotation PairProblem::world_rotation(double angle, double drift, const Vec2& tilt,
                                          const std::vector<double>& offsets) const {
  WorldRotation rotation{{angle + offsets[0], drift, 0.5 * (begin_ + end_)}, tilt};
  for (std::size_t part = 1; part < offsets.size(); ++part)
    rotation.heading.steps.push_back({part_begin_[part], offsets[part] - offsets[part - 1]});
  return rotation;
}

/// Squared deviations of the headings from the magnetometers' in units of their sd.
double PairProblem::magnetic_cost(const WorldRotation& world_rotation) const {
  if (headings_ == HeadingReference::arbitrary) return 0.0;
  const auto square_of = [](double heading) {
    const double ratio = wrap_to_pi(heading) / magnetic_heading_sd;
    return ratio * ratio;
  };
  double heading = world_rotation.heading.angle, cost = square_of(heading);
  for (const HeadingStep& step : world_rotation.heading.steps) cost += square_of(heading += step.angle);
  return cost;
}

double PairProblem::cost(const std::vector<PartSums>& sums, const WorldRotation& world_rotation) const {
  PartSums all;
  for (const PartSums& part : sums) all.force += part.force, all.angular_velocity += part.angular_velocity;
  const Normal normal = normal_equations(all.force);
  const auto x = solve_spd(normal.matrix, -normal.right);
  const double square = normal.square + (x ? x->dot(normal.right) : 0.0);
  const double noise = pair_acceleration_floor * pair_acceleration_floor;
  const double drift_ratio = world_rotation.heading.drift / heading_drift_sd;
  const double tilt_ratio_squared = world_rotation.tilt.squaredNorm() / (vertical_tilt_sd * vertical_tilt_sd);
  const double independent_samples = static_cast<double>(rows_.size()) / rows_per_independent_sample;
  return 1.5 * std::log(std::max(0.0, square) / 3.0 + noise) + code_length(all.angular_velocity, pair_rate_floor) +
         0.5 * (drift_ratio * drift_ratio + magnetic_cost(world_rotation) + tilt_ratio_squared) / independent_samples;
}

void PairProblem::solve(PairFit& fit, const Mat3& weight) const {
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

PairProblem::PartSums PairProblem::sums_of(std::size_t part, const WorldRotation& world_rotation) const {
  PartSums sums;
  for (std::size_t w = first_window_[part]; w < first_window_[part + 1]; ++w) {
    const HeadingWindow& window = windows_[w];
    const Mat3 e = world_rotation.at(window.time);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) sums.force += e(i, j) * window.force[i][j];
    Eigen::Matrix<double, rate_parts, 1> factor;
    factor << 1.0, e.reshaped<Eigen::RowMajor>();
    Eigen::Matrix<double, 3, 3 * rate_parts> half = Eigen::Matrix<double, 3, 3 * rate_parts>::Zero();
    for (int i = 0; i < rate_parts; ++i) half += factor[i] * window.angular_velocity.middleRows<3>(3 * i);
    for (int i = 0; i < rate_parts; ++i) sums.angular_velocity += factor[i] * half.middleCols<3>(3 * i);
  }
  return sums;
}

std::vector<PairProblem::PartSums> PairProblem::sums_of_parts(const WorldRotation& world_rotation) const {
  std::vector<PartSums> sums;
  for (std::size_t part = 0; part < parts_.size(); ++part) sums.push_back(sums_of(part, world_rotation));
  return sums;
}

Mat3 PairProblem::mean_square_rate(const WorldRotation& world_rotation) const {
  Mat3 sum = Mat3::Zero();
  for (const PartSums& part : sums_of_parts(world_rotation)) sum += part.angular_velocity;
  return sum;
}

/// Diagonal prior of the normal equations of a mean square, for a residual at its floor.
Eigen::Matrix<double, 12, 1> PairProblem::prior() const {
  const double noise = pair_acceleration_floor * pair_acceleration_floor;
  const auto of = [&](double sd) { return noise / (sd * sd); };
  Eigen::Matrix<double, 12, 1> diagonal;
  diagonal << Vec3::Constant(of(lever_arm_sd)), Vec3::Constant(of(pair_bias_sd)), Vec3::Constant(of(lever_arm_sd)),
      Vec3::Constant(of(pair_bias_sd));
  return diagonal;
}

void PairProblem::make_windows() {
  std::vector<double> restarts = a_.restarts;
  restarts.insert(restarts.end(), b_.restarts.begin(), b_.restarts.end());
  std::ranges::sort(restarts);
  const double length = std::max(end_ - begin_, 1e-9);
  std::size_t gaps = 0, last_gaps = 0, last_window = heading_windows;
  for (const std::size_t row : rows_) {
    const double time = motion_.time[row];
    while (gaps < restarts.size() && restarts[gaps] <= time) ++gaps;
    const auto window = std::min(
        heading_windows - 1, static_cast<std::size_t>((time - begin_) / length * static_cast<double>(heading_windows)));
    if (parts_.empty() || gaps != last_gaps) {
      parts_.push_back(0);
      part_begin_.push_back(gaps > 0 ? restarts[gaps - 1] : begin_);
      first_window_.push_back(windows_.size());
    }
    if (windows_.empty() || gaps != last_gaps || window != last_window) {
      windows_.emplace_back();
      for (auto& moments : windows_.back().force) moments.fill(Mat7::Zero());
    }
    ++parts_.back();
    last_gaps = gaps;
    last_window = window;
    add(windows_.back(), row);
  }
  first_window_.push_back(windows_.size());
}

void PairProblem::add(HeadingWindow& window, std::size_t row) {
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

PairProblem::Normal PairProblem::normal_equations(const Mat7& mixed) const {
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
Eigen::Matrix<double, 3, 13> PairProblem::difference_jacobian(const WorldRotation& world_rotation,
                                                              std::size_t row) const {
  const Mat3 first_R_world = a_.rotation[row].transpose();
  const Row7 u = first_R_world * point_jacobian(a_, row, motion_.gravity),
             v = first_R_world * world_rotation.at(motion_.time[row]) * point_jacobian(b_, row, motion_.gravity);
  Eigen::Matrix<double, 3, 13> k;
  k << -u.leftCols<6>(), v.leftCols<6>(), v.col(6) - u.col(6);
  return k;
}

double PairFit::off_axis_rate() const {
  const VectorXd squares = symmetric_eigen(angular_velocity).values;
  return std::sqrt(std::max(0.0, squares[0] + squares[1]));
}

}  // namespace kinfer::identify
