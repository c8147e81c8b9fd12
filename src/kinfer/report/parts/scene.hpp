// SPDX-License-Identifier: Apache-2.0
// Static projection of lines, dots and names in space: the printed view of the machine.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinfer/geometry/pose.hpp"
#include "kinfer/report/parts/plot.hpp"

namespace kinfer::report::svg {

class Scene {
 public:
  void line(const std::vector<Vec3>& points, std::string_view kind);
  void dot(const Vec3& point, double radius, std::string_view kind);
  void dots(const std::vector<Vec3>& points, double radius, std::string_view kind);
  /// Separate lines between pairs of points.
  void strokes(const std::vector<Vec3>& pairs, std::string_view kind);
  void name(const Vec3& point, std::string_view words);

  /// Orthographic view from the front left and slightly above, z upwards, fitted to the frame.
  std::string svg(Size size, std::string_view description) const;

  /// Half of the largest extent [m]; 0 if empty.
  double radius() const;

 private:
  enum class Shape { line, strokes, dots, name };
  struct Mark {
    Shape shape;
    std::vector<Vec3> points;
    double radius;  ///< of a dot
    std::string kind, words;
  };
  std::vector<Mark> marks_;
};

}  // namespace kinfer::report::svg
