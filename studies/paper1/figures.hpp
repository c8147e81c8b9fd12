// SPDX-License-Identifier: Apache-2.0
// Line charts as SVG, for paper 1's figures 8 and 9.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kinfer::study::paper1_study {

struct Line {
  std::string label;
  std::vector<double> x, y;
  std::string colour = "#1f4e79";
};

enum class Scale { linear, logarithmic };

struct Chart {
  std::string title, x_label, y_label;
  std::vector<Line> lines;
  Scale y_scale = Scale::linear;
};

/// Charts below each other.
void write_svg(const std::filesystem::path& path, const std::vector<Chart>& charts);

}  // namespace kinfer::study::paper1_study
