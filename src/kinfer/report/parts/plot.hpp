// SPDX-License-Identifier: Apache-2.0
// Plots as SVG: printable, without scripts, coloured by the page style (light, dark, paper).
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinfer::report::svg {

enum class Scale { linear, logarithmic };
enum class AxisNumbers { shown, hidden };

struct Axis {
  std::string label{};
  double low = 0.0, high = 1.0;
  Scale scale = Scale::linear;
  AxisNumbers numbers = AxisNumbers::shown;  ///< hidden: neither numbers nor grid lines
};

struct Size {
  double width = 480.0, height = 270.0;
};

/// Axes with round tick values, and marks in data coordinates. `kind` is the CSS class of the mark.
class Plot {
 public:
  Plot(Axis x, Axis y, Size size = {});

  void bar(double x0, double x1, double y0, double y1, std::string_view kind, std::string_view tip = {});
  void dot(double x, double y, double radius, std::string_view kind, std::string_view attributes = {},
           std::string_view tip = {});
  /// Many dots of one kind as a single path: compact, not individually selectable.
  void cloud(const std::vector<double>& x, const std::vector<double>& y, double radius, std::string_view kind);
  void line(const std::vector<double>& x, const std::vector<double>& y, std::string_view kind);
  /// The area between two curves.
  void area(const std::vector<double>& x, const std::vector<double>& low, const std::vector<double>& high,
            std::string_view kind);
  void across(double y, std::string_view kind, std::string_view words);  ///< horizontal line over the whole width
  void window(double x0, double x1, std::string_view kind);              ///< vertical stripe over the whole height
  void words(double x, double y, std::string_view kind, std::string_view text);

  /// `description`: text alternative (aria-label).
  std::string svg(std::string_view description) const;

 private:
  double px(double x) const;
  double py(double y) const;
  std::string axes() const;

  Axis x_, y_;
  Size size_;
  std::string marks_;
};

/// Ticks at 1, 2 or 5 times a power of ten (about `count`), or at powers of ten.
std::vector<double> ticks(const Axis& axis, int count);

/// Limits that contain all finite values, with a small margin; `zero`: starting at zero.
enum class From { zero, least };
Axis axis_for(std::string label, const std::vector<double>& values, From from);
Axis log_axis_for(std::string label, const std::vector<double>& values);

/// A grid of coloured squares with names on both sides; values −1 .. 1.
std::string heat_map(const std::vector<std::string>& names, const std::vector<std::vector<double>>& values,
                     std::string_view description);

/// Round dots as one path of zero-length segments with round line caps.
std::string dots(const std::string& points, double radius, std::string_view kind);

/// A coordinate rounded to 0.1 units, finer than a pixel.
std::string coordinate(double value);

}  // namespace kinfer::report::svg
