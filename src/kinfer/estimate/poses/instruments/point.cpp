// SPDX-License-Identifier: Apache-2.0
// Measured point: position − (p + R t), with t the target in the tool frame (zero for the tool point).
// d(p + R t) = dp + dω × R t + R dt.

#include "kinfer/estimate/poses/instruments/residual_kind.hpp"

namespace kinfer {
namespace {

void point_residual(const ResidualContext& scene, std::size_t index, BlockRows& out) {
  const PointMeasurement& point = scene.data.points[index];
  const Pose& pose = scene.at.pose[point.row];
  const bool has_target = point.target >= 0;
  const Vec3 arm = has_target ? Vec3(pose.rotation * scene.chain.targets[point.target].xyz) : Vec3::Zero().eval();
  out.residuals.segment<3>(out.row) = along_axes(point.axes, point.position - pose.position - arm);
  if (!out.jacobian) return;
  const Twists& twist = scene.at.twists[point.row];
  auto rows = out.jacobian->middleRows<3>(out.row);
  if (has_target) {
    const Mat3 turn = -skew(arm);
    rows = -(twist.topRows<3>() + turn * twist.bottomRows<3>());
    for (int k = 0; k < 3; ++k)
      if (const Eigen::Index column = scene.columns.target[point.target][k]; column >= 0)
        rows.col(column) = -pose.rotation.col(k);
  } else {
    rows = -twist.topRows<3>();
  }
  if (point.axes) rows = (point.axes->transpose() * rows).eval();
}

Vec3 point_sd(const PoseSet& data, std::size_t index, const Instrument& instrument) {
  const PointMeasurement& point = data.points[index];
  return point.sd ? *point.sd : Vec3::Constant(position_sd(instrument, point.position));
}

}  // namespace

template <>
ResidualModel residual_model<PointMeasurement>() {
  return {.write = point_residual, .specified_sd = point_sd};
}

}  // namespace kinfer
