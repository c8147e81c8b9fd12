// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/parts/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "kinfer/base/angle.hpp"
#include "kinfer/report/parts/html.hpp"

namespace kinfer::report::svg {
namespace {

using Point2 = Eigen::Vector2d;

Point2 project(const Vec3& point) {
  static const Mat3 turn = rot_x(-20.0 * degree) * rot_z(-215.0 * degree);  // y: depth, z: upwards
  const Vec3 p = turn * point;
  return {p.x(), -p.z()};
}

bool is_drawable(const Vec3& point) {
  return point.allFinite() && point.cwiseAbs().maxCoeff() < 1e9;  // [m]; sums and scales of them stay finite
}

std::vector<Vec3> drawable(std::vector<Vec3> points) {
  std::erase_if(points, std::not_fn(is_drawable));
  return points;
}

}  // namespace

void Scene::line(const std::vector<Vec3>& points, std::string_view kind) {
  marks_.push_back({Shape::line, drawable(points), 0.0, std::string(kind), {}});
}

void Scene::strokes(const std::vector<Vec3>& pairs, std::string_view kind) {
  Mark mark{Shape::strokes, {}, 0.0, std::string(kind), {}};
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 2)
    if (is_drawable(pairs[i]) && is_drawable(pairs[i + 1]))
      mark.points.insert(mark.points.end(), {pairs[i], pairs[i + 1]});
  if (!mark.points.empty()) marks_.push_back(std::move(mark));
}

void Scene::dot(const Vec3& point, double radius, std::string_view kind) {
  dots({point}, radius, kind);
}

void Scene::dots(const std::vector<Vec3>& points, double radius, std::string_view kind) {
  if (const std::vector<Vec3> shown = drawable(points); !shown.empty())
    marks_.push_back({Shape::dots, shown, radius, std::string(kind), {}});
}

void Scene::name(const Vec3& point, std::string_view words) {
  if (is_drawable(point)) marks_.push_back({Shape::name, {point}, 0.0, "name", std::string(words)});
}

double Scene::radius() const {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Mark& mark : marks_)
    for (const Vec3& point : mark.points) low = low.cwiseMin(point), high = high.cwiseMax(point);
  return marks_.empty() ? 0.0 : 0.5 * (high - low).maxCoeff();
}

std::string Scene::svg(Size size, std::string_view description) const {
  Point2 low = Point2::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Mark& mark : marks_)
    for (const Vec3& point : mark.points) low = low.cwiseMin(project(point)), high = high.cwiseMax(project(point));
  constexpr double margin = 34.0;
  const Point2 extent = (high - low).cwiseMax(1e-6);
  const double scale = std::min((size.width - 2 * margin) / extent.x(), (size.height - 2 * margin) / extent.y());
  const Point2 middle = 0.5 * (low + high);
  const auto at = [&](const Vec3& point) -> Point2 {
    return scale * (project(point) - middle) + Point2(0.5 * size.width, 0.5 * size.height);
  };
  const auto pair = [&](const Vec3& point) { return coordinate(at(point).x()) + " " + coordinate(at(point).y()); };
  std::string text;
  for (const Mark& mark : marks_) {
    std::string path;
    for (std::size_t i = 0; i < mark.points.size(); ++i) {
      const bool starts = mark.shape == Shape::dots || i == 0 || (mark.shape == Shape::strokes && i % 2 == 0);
      path += (starts ? "M" : "L") + pair(mark.points[i]) + (mark.shape == Shape::dots ? "h0" : "");
    }
    if (mark.shape == Shape::name) {
      const Point2 place = at(mark.points.front());
      text += fmt::format("<text class=\"name\" x=\"{}\" y=\"{}\">{}</text>", coordinate(place.x() + 8),
                          coordinate(place.y() - 7), html::escape(mark.words));
    } else if (mark.shape == Shape::dots) {
      text += svg::dots(path, mark.radius, mark.kind);
    } else {
      text += fmt::format("<path class=\"{}\" d=\"{}\"/>", mark.kind, path);
    }
  }
  return fmt::format("<svg class=\"scene\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">{}</svg>",
                     coordinate(size.width), coordinate(size.height), html::escape(description), text);
}

}  // namespace kinfer::report::svg
