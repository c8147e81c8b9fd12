// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/parts/plan_figure.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kinfer/report/parts/plot.hpp"

namespace kinfer::report {
namespace {

constexpr const char* plan_style =
    "<style>svg{font:12px sans-serif;background:#fff}text{fill:#444}.ty{text-anchor:end}.tx,.lx,.ly{text-anchor:middle}"
    ".grid{stroke:#e5e5e5;fill:none}.axis{stroke:#888;fill:none}.planned{stroke:#0b6;fill:none;stroke-width:2}"
    ".random{stroke:#c60;fill:none;stroke-width:2}.worst{stroke-dasharray:5 4}.level{text-anchor:end}"
    ".noise{stroke:#999;fill:none}.chosen{fill:#0b6}text.planned{fill:#0b6;stroke:none}text.random{fill:#c60;stroke:"
    "none}"
    "</style>";

struct Curve {
  std::vector<double> poses, rms, worst;  // [1], [mm]
};

/// The curve from the first point whose worst error is at most `highest` [mm].
Curve shown(const std::vector<ExpectedError>& points, double highest) {
  Curve curve;
  for (const ExpectedError& point : points) {
    if (curve.poses.empty() && 1e3 * point.worst > highest) continue;
    curve.poses.push_back(point.poses);
    curve.rms.push_back(1e3 * point.rms);
    curve.worst.push_back(1e3 * point.worst);
  }
  return curve;
}

void draw(svg::Plot& plot, const Curve& curve, const std::string& kind, const std::string& words) {
  plot.line(curve.poses, curve.rms, kind);
  plot.line(curve.poses, curve.worst, kind + " worst");
  if (curve.poses.empty()) return;
  const std::size_t middle = curve.poses.size() / 3;
  plot.words(curve.poses[middle], 1.08 * curve.worst[middle], kind, words);
}

}  // namespace

std::string plan_figure(const PosePlan& plan) {
  const double highest = 20e3 * std::max(plan.expected.worst, 1e-9);
  const Curve planned = shown(plan.planned_curve, highest), random = shown(plan.random_curve, highest);
  std::vector<double> poses = planned.poses, errors = planned.rms;
  poses.insert(poses.end(), random.poses.begin(), random.poses.end());
  for (const auto* list : {&planned.worst, &random.rms, &random.worst})
    errors.insert(errors.end(), list->begin(), list->end());
  errors.push_back(1e3 * plan.expected.rms);
  svg::Plot plot(svg::axis_for("poses measured", poses, svg::From::least),
                 svg::log_axis_for("expected error of the tool [mm]", errors), {720, 420});
  draw(plot, random, "random", "random poses");
  draw(plot, planned, "planned", "planned one by one");
  plot.dot(plan.expected.poses, 1e3 * plan.expected.rms, 4, "chosen");
  plot.dot(plan.expected.poses, 1e3 * plan.expected.worst, 4, "chosen");
  if (!poses.empty())
    plot.words(poses.front(), *std::max_element(errors.begin(), errors.end()), "note",
               "solid: rms over the workspace, dashed: worst place, dots: the poses of this plan");
  std::string text = plot.svg(
      "Expected error of the tool over the workspace by the number of poses. Solid: rms; dashed: "
      "worst place. Dots: the poses of this plan, which were exchanged until none was better.");
  const std::size_t end = text.find('>');
  return "<?xml version=\"1.0\"?>\n" + text.substr(0, end) + " xmlns=\"http://www.w3.org/2000/svg\">" + plan_style +
         text.substr(end + 1) + "\n";
}

}  // namespace kinfer::report
