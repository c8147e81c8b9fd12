#include "kinfer/identify/joint_film.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

MatrixXd spline_values(const SplineGrid& grid, ConstMatrixRef coefficients, std::span<const double> times) {
  MatrixXd values(coefficients.rows(), static_cast<Index>(times.size()));
  for (std::size_t i = 0; i < times.size(); ++i)
    values.col(static_cast<Index>(i)) = spline_value(grid, coefficients, times[i]);
  return values;
}

/// parent_R_child behind the last joint of the bodies is this times a constant.
Mat3 ball_rotation(const VectorXd& vector) {
  return exp_so3(Vec3(vector));
}

MatrixXd ball_film(const MatrixXd& turns, const Mat3& axes) {
  MatrixXd film(3, turns.cols());
  Vec3 before = Vec3::Zero();
  for (Index i = 0; i < turns.cols(); ++i) {
    before = cardan_angles(axes.transpose() * exp_so3(Vec3(turns.col(i))) * axes, before);
    film.col(i) = before;
  }
  return film;
}

}  // namespace

Vec3 cardan_angles(const Mat3& r, const Vec3& before) {
  constexpr double half = std::numbers::pi, whole = 2.0 * half;
  const double cosine = std::hypot(r(0, 0), r(0, 1));
  Vec3 one(before.x(), std::atan2(r(0, 2), cosine), 0.0);
  if (cosine > 1e-9) {
    one.x() = std::atan2(-r(1, 2), r(2, 2));
    one.z() = std::atan2(-r(0, 1), r(0, 0));
  } else {  // only the sum or the difference of the outer angles is told
    const Mat3 rest = (rot_x(one.x()) * rot_y(one.y())).transpose() * r;
    one.z() = std::atan2(rest(1, 0), rest(0, 0));
  }
  const auto near = [&](Vec3 angles) {
    for (Index k = 0; k < 3; ++k) angles[k] += whole * std::round((before[k] - angles[k]) / whole);
    return angles;
  };
  const Vec3 first = near(one), second = near({one.x() + half, half - one.y(), one.z() + half});
  return (first - before).norm() <= (second - before).norm() ? first : second;
}

MatrixXd ball_turns(const SplineGrid& grid, ConstMatrixRef coefficients, std::span<const double> times) {
  const Mat3 home = ball_rotation(spline_value(grid, coefficients, grid.begin));
  MatrixXd turns = spline_values(grid, coefficients, times);
  for (Index i = 0; i < turns.cols(); ++i) turns.col(i) = log_so3(ball_rotation(turns.col(i)) * home.transpose());
  return turns;
}

Mat3 ball_axes(ConstMatrixRef turns) {
  const SymmetricEigen eigen = symmetric_eigen(turns * turns.transpose());
  Mat3 axes;
  axes.col(0) = eigen.vectors.col(2);
  axes.col(1) = eigen.vectors.col(0);
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

MatrixXd joint_film(FoundJointType type, std::span<const InsBody> bodies, const HingeGeometry& geometry,
                    const SplineGrid& grid, ConstMatrixRef coefficients, std::span<const double> times) {
  if (type == FoundJointType::rigid) return {};
  if (type == FoundJointType::spherical) return ball_film(ball_turns(grid, coefficients, times), geometry.ball_axes);
  MatrixXd film = spline_values(grid, coefficients, times);
  film.colwise() -= spline_value(grid, coefficients, grid.begin);
  if (bodies.size() == 1 && geometry.axis_in_parent.dot(bodies.front().parent_R_axis.col(2)) < 0.0) film = -film;
  return film;
}

}  // namespace kinfer
