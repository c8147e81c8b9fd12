// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "kinfer/report/calibrate/figures.hpp"
#include "kinfer/report/parts/quantile.hpp"
#include "kinfer/report/parts/scene.hpp"

namespace kinfer::report {
namespace {

using ErrorVector = std::optional<Vec3> PlotRow::*;

/// Exaggeration of the error vectors: a typical one is drawn as long as a tenth of the machine.
double exaggeration(const std::vector<PlotRow>& rows, double size) {
  std::vector<double> lengths;
  for (const PlotRow& row : rows)
    if (row.error_before) lengths.push_back(row.error_before->norm());
  const double typical = quantile(finite_sorted(lengths), 0.5);
  return round_down(0.1 * size / (typical > 1e-12 ? typical : 1e-3));
}

void draw_errors(svg::Scene& scene, const std::vector<PlotRow>& rows, ErrorVector error, double times,
                 const char* kind) {
  std::vector<Vec3> pairs;
  for (const PlotRow& row : rows)
    if (row.measured && row.*error) {
      pairs.push_back(*row.measured);
      pairs.push_back(*row.measured + times * *(row.*error));
    }
  scene.strokes(pairs, kind);
}

void draw_measured_points(svg::Scene& scene, const std::vector<PlotRow>& rows) {
  std::vector<Vec3> points;
  for (const PlotRow& row : rows)
    if (row.measured) points.push_back(*row.measured);
  scene.dots(points, 1.6, "pose");
}

void draw_chain(svg::Scene& scene, const ChainView& chain, const std::vector<double>& q) {
  const auto joints = place_joints(chain, q);
  std::vector<Vec3> line{chain.base.xyz};
  for (const JointViewPlacement& joint : joints) line.push_back(joint.frame.position);
  line.push_back(tool_pose(chain, joints).position);
  scene.line(line, "link");
  const double half = 0.12 * scene.radius();
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (joints[i].axis.norm() > 0.0) {
      scene.line({joints[i].point - half * joints[i].axis, joints[i].point + half * joints[i].axis}, "joint-axis");
      scene.dot(joints[i].point, 3.5, "joint");
      scene.name(joints[i].point, chain.joints[i].name);
    }
  scene.dot(line.back(), 4.0, "tool");
}

}  // namespace

std::string calibrated_machine_drawing(const CalibrationEvidence& evidence) {
  const PictureRecord& picture = evidence.picture;
  if (picture.chains.calibrated.joints.empty()) return "";
  std::vector<double> q;
  if (picture.joints.cols() > 0) q.assign(picture.joints.col(0).begin(), picture.joints.col(0).end());
  svg::Scene scene;
  draw_measured_points(scene, picture.rows);
  draw_chain(scene, picture.chains.calibrated, q);
  const double times = exaggeration(picture.rows, scene.radius());
  draw_errors(scene, picture.rows, &PlotRow::error_before, times, "off-before");
  draw_errors(scene, picture.rows, &PlotRow::error_after, times, "off-after");
  return scene.svg({640, 460}, "The calibrated chain in its first pose, and the measured points") +
         fmt::format(
             "<p class=\"note\">The robot in the first pose; at each measured point its error before (grey) and after "
             "(blue), exaggerated {:.0f} times.</p>",
             times);
}

}  // namespace kinfer::report
