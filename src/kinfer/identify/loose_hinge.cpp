#include "kinfer/identify/loose_hinge.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/identify/joint_type.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

struct Axes {
  Vec3 in_parent, in_child;
};

Axes nearest_axes(std::span<const Mat3> rotations) {
  Mat3 mean = Mat3::Zero();
  for (const Mat3& r : rotations) mean += r / static_cast<double>(rotations.size());
  const Vec3 b = symmetric_eigen(mean.transpose() * mean).vectors.col(2);
  return {(mean * b).normalized(), b};
}

/// How far one axis strays from the other's frame, in the two directions across it.
std::array<double, 2> axis_variance(std::span<const Mat3> rotations, const Mat3& frame, const Vec3& other,
                                    bool in_parent) {
  std::array<double, 2> variance{};
  for (Index k = 0; k < 2; ++k) {
    std::vector<double> offset;
    double square = 0.0;
    for (const Mat3& r : rotations) {
      offset.push_back(frame.col(k).dot(in_parent ? Vec3(r * other) : Vec3(r.transpose() * other)));
      square += offset.back() * offset.back();
    }
    variance[static_cast<std::size_t>(k)] = square / static_cast<double>(rotations.size()) / effective_samples(offset);
  }
  return variance;
}

double stray_of(std::span<const Mat3> rotations, const Axes& axes) {
  double square = 0.0;
  for (const Mat3& r : rotations) {
    const double angle = std::acos(std::clamp(axes.in_parent.dot(r * axes.in_child), -1.0, 1.0));
    square += angle * angle / static_cast<double>(rotations.size());
  }
  return std::sqrt(square);
}

double reading_of(const InsBody& hinge, const Mat3& rotation) {
  const Mat3 turn = hinge.parent_R_axis.transpose() * rotation * hinge.child_R_axis;
  return std::atan2(turn(1, 0) - turn(0, 1), turn(0, 0) + turn(1, 1));
}

/// Covariance of a point whose frame turns by small angles of this variance about any axis.
Mat3 turned_point(const Vec3& point, double variance) {
  return variance * (point.squaredNorm() * Mat3::Identity() - point * point.transpose());
}

}  // namespace

LooseHinge loose_hinge(const InsBody& ball, std::span<const Mat3> rotations, ConstMatrixRef points, double crossed) {
  const Axes axes = nearest_axes(rotations);
  const Mat3 a = frame_along(axes.in_parent), b = frame_along(axes.in_child);
  LooseHinge hinge{turning_body(ball.parent, ball.sensor, a, b), 0.0, stray_of(rotations, axes),
                   MatrixXd::Zero(10, 10)};
  hinge.body.point_in_parent = ball.point_in_parent;
  hinge.body.point_in_child = ball.point_in_child;
  hinge.zero = reading_of(hinge.body, rotations.front());
  // A turn about x moves the axis along −y, one about y along x.
  const auto in_parent = axis_variance(rotations, a, axes.in_child, true),
             in_child = axis_variance(rotations, b, axes.in_parent, false);
  hinge.covariance.diagonal().head<4>() << in_parent[1], in_parent[0], in_child[1], in_child[0];
  hinge.covariance.diagonal().head<4>().array() += crossed * crossed;
  hinge.covariance.bottomRightCorner<6, 6>() = points;
  // A frame that is turned against its segment as much as the axis strays sees the joint's point turned, too.
  hinge.covariance.block<3, 3>(4, 4) += turned_point(ball.point_in_parent, 0.5 * (in_parent[0] + in_parent[1]));
  hinge.covariance.block<3, 3>(7, 7) += turned_point(ball.point_in_child, 0.5 * (in_child[0] + in_child[1]));
  return hinge;
}

MatrixXd loose_film(const LooseHinge& hinge, std::span<const Mat3> rotations) {
  MatrixXd film(1, static_cast<Index>(rotations.size()));
  double before = 0.0;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const double reading = reading_of(hinge.body, rotations[i]) - hinge.zero;
    before += std::remainder(reading - before, 2.0 * std::numbers::pi);
    film(0, static_cast<Index>(i)) = before;
  }
  return film;
}

void loosen(InsUnknowns& x, const InsLayout& layout, std::size_t body) {
  InsBody& hinge = x.bodies[body];
  // exp(φ) home = A Rz(q) Bᵀ with home = A Rz(middle) Bᵀ: φ = (q − middle) a.
  const VectorXd reading = x.band.row(layout.channel[body]);
  const double middle = 0.5 * (reading.minCoeff() + reading.maxCoeff());
  InsBody ball =
      ball_body(hinge.parent, hinge.sensor, hinge.parent_R_axis * rot_z(middle) * hinge.child_R_axis.transpose());
  ball.point_in_parent = hinge.point_in_parent;
  ball.point_in_child = hinge.point_in_child;
  const Index at = layout.channel[body], after = x.band.rows() - at - 1;
  MatrixXd band(x.band.rows() + 2, x.band.cols());
  band.topRows(at) = x.band.topRows(at);
  band.middleRows<3>(at) = hinge.parent_R_axis.col(2) * (reading.array() - middle).matrix().transpose();
  band.bottomRows(after) = x.band.bottomRows(after);
  hinge = ball;
  x.band = std::move(band);
}

}  // namespace kinfer
