// SPDX-License-Identifier: Apache-2.0
// Ball-bar: its known length − |p_row − p_other|, the distance between the tool points of two poses.

#include "kinfer/estimate/poses/instruments/residual_kind.hpp"

namespace kinfer {
namespace {

void ball_bar_residual(const ResidualContext& scene, std::size_t index, BlockRows& out) {
  const PairDistance& pair = scene.data.pairs[index];
  const Vec3 bar = scene.at.pose[pair.row].position - scene.at.pose[pair.other].position;
  const double length = bar.norm();
  out.residuals[out.row] = pair.distance - length;
  if (!out.jacobian) return;
  const Vec3 along = length > 0.0 ? Vec3(bar / length) : Vec3::UnitX().eval();
  out.jacobian->row(out.row) =
      -along.transpose() * (scene.at.twists[pair.row].topRows<3>() - scene.at.twists[pair.other].topRows<3>());
}

Vec3 ball_bar_sd(const PoseSet& data, std::size_t index, const Instrument& instrument) {
  return Vec3::Constant(PairDistance::traits.sigma_of(instrument) + 1e-6 * instrument.ppm * data.pairs[index].distance);
}

}  // namespace

template <>
ResidualModel residual_model<PairDistance>() {
  return {.write = ball_bar_residual, .specified_sd = ball_bar_sd};
}

}  // namespace kinfer
