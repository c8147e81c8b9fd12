// SPDX-License-Identifier: Apache-2.0
// Tables as CSV and Markdown, figures as SVG.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kinfer::paper2 {

/// A table that is written as CSV and quoted in the summary.
struct TextTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
  std::string csv() const;
  std::string markdown() const;
};

struct Series {
  std::string name;
  std::vector<double> y;
};

/// One bar a value, like the paper's error figures.
std::string bar_svg(const std::string& title, const std::string& x_label, const std::string& y_label,
                    const std::vector<double>& y);

/// Lines over 0, 1, 2 …; y on a logarithmic axis.
std::string line_svg(const std::string& title, const std::string& x_label, const std::string& y_label,
                     const std::vector<Series>& series);

/// Stops the study with a sentence where the file cannot be written.
void write(const std::filesystem::path& path, const std::string& text);

}  // namespace kinfer::paper2
