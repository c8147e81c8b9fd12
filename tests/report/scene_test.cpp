// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/parts/scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

namespace kinfer::report {
namespace {

/// All pairs of coordinates of the paths of one class.
std::vector<std::pair<double, double>> points_of(const std::string& svg, const std::string& kind) {
  const std::regex path("class=\"[^\"]*" + kind + "\"[^>]* d=\"([^\"]*)\""), point("[ML](-?[0-9.]+) (-?[0-9.]+)");
  std::smatch found;
  std::vector<std::pair<double, double>> points;
  if (!std::regex_search(svg, found, path)) return points;
  const std::string d = found[1];
  for (auto at = std::sregex_iterator(d.begin(), d.end(), point); at != std::sregex_iterator(); ++at)
    points.emplace_back(std::stod((*at)[1]), std::stod((*at)[2]));
  return points;
}

TEST(Scene, UpIsUpAndEverythingIsInsideTheFrame) {
  svg::Scene scene;
  scene.line({Vec3::Zero(), Vec3(0, 0, 2), Vec3(3, -1, 1)}, "arm");
  const auto points = points_of(scene.svg({640, 460}, "arm"), "arm");
  ASSERT_EQ(points.size(), 3u);
  EXPECT_GT(points[0].second, points[1].second);  // SVG counts downwards
  EXPECT_NEAR(points[0].first, points[1].first, 0.11);
  for (const auto& [x, y] : points) {
    EXPECT_GE(x, 0.0);
    EXPECT_LE(x, 640.0);
    EXPECT_GE(y, 0.0);
    EXPECT_LE(y, 460.0);
  }
}

TEST(Scene, EqualLengthsOfOneDirectionAreDrawnEquallyLong) {
  svg::Scene scene;
  scene.line({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)}, "arm");
  const auto p = points_of(scene.svg({640, 460}, "arm"), "arm");
  EXPECT_NEAR(p[1].first - p[0].first, p[2].first - p[1].first, 0.21);
}

TEST(Scene, StrokesAreSeparateLines) {
  svg::Scene scene;
  scene.strokes({Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}, "error");
  const std::string svg = scene.svg({640, 460}, "errors");
  EXPECT_EQ(std::ranges::count(svg.substr(svg.find(" d=\"")), 'M'), 2);
}

TEST(Scene, RadiusIsHalfOfTheLargestExtent) {
  svg::Scene scene;
  EXPECT_EQ(scene.radius(), 0.0);
  scene.dots({Vec3(-1, 0, 0), Vec3(3, 1, 0)}, 1.0, "pose");
  EXPECT_EQ(scene.radius(), 2.0);
}

TEST(Scene, NamesAndDescriptionAreEscaped) {
  svg::Scene scene;
  scene.name(Vec3::Zero(), "<J1>");
  const std::string svg = scene.svg({640, 460}, "a \"scene\"");
  EXPECT_NE(svg.find("&lt;J1&gt;"), std::string::npos);
  EXPECT_NE(svg.find("a &quot;scene&quot;"), std::string::npos);
}

TEST(Scene, WithoutMarksIsAnEmptyDrawing) {
  const svg::Scene scene;
  EXPECT_NE(scene.svg({640, 460}, "nothing").find("<svg"), std::string::npos);
}

}  // namespace
}  // namespace kinfer::report
