// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/update/bent_axes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace kinfer::identify {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

/// Rows of the rotations of A about its own x and y; none unless both are estimated.
std::optional<Eigen::Matrix2d> axis_covariance(const TrackingModel& model, int body) {
  std::vector<Index> rows;
  for (int component = 0; component < 2; ++component) {
    const TrackingParameter p{TrackingParameterKind::parent_rotation, body, component};
    const auto row = std::ranges::find(model.parameters, p) - model.parameters.begin();
    if (row == std::ssize(model.parameters)) return std::nullopt;
    rows.push_back(row);
  }
  return Eigen::Matrix2d(model.covariance(rows, rows));
}

/// The cone about the unit vector `about`, in the frame of A.
double bend_about(const Vec3& about, const Eigen::Matrix2d& covariance) {
  const Vector2d across(about.x(), about.y());
  const double sine = across.norm(), cosine = std::abs(about.z());
  if (sine < 1e-9) return 0.0;
  const Vector2d tangent = across / sine, radial(-tangent.y(), tangent.x());
  const double along = std::sqrt(tangent.dot(covariance * tangent)), width = std::sqrt(radial.dot(covariance * radial));
  const double bend = std::min(0.5 * along * along * cosine / sine, 2.0 * sine);
  return width > 0.0 ? bend / width : 0.0;
}

/// Directions of the parent about which its log may not tell where an axis lies.
std::vector<Vec3> cone_axes(const TrackingModel& model, const TrackingBody& parent) {
  std::vector<Vec3> axes;
  if (parent.joint < 0 && !model.base.moved && model.base.force.norm() > 0.0)
    axes.push_back(model.base.force.normalized());
  if (parent.motion == TrackingMotion::revolute) axes.push_back(parent.child_R_axis.col(2));
  return axes;
}

}  // namespace

std::vector<double> axis_bends(const TrackingModel& model) {
  std::vector<double> bends(model.bodies.size(), 0.0);
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const TrackingBody& body = model.bodies[b];
    const auto covariance = axis_covariance(model, static_cast<int>(b));
    if (!covariance) continue;
    for (const Vec3& axis : cone_axes(model, model.bodies[static_cast<std::size_t>(body.parent)]))
      bends[b] = std::max(bends[b], bend_about(body.parent_R_axis.transpose() * axis, *covariance));
  }
  return bends;
}

}  // namespace kinfer::identify
