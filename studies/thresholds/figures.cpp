// SPDX-License-Identifier: Apache-2.0
#include "studies/thresholds/figures.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kinfer::study::thresholds_study {

std::string changes(const Figures& standard, const Figures& varied) {
  std::string text;
  for (std::size_t i = 0; i < standard.size(); ++i) {
    const double from = standard[i].value, to = varied[i].value;
    if (std::abs(to - from) <= 0.01 * std::abs(from)) continue;
    text += fmt::format("{}{} {:.3g} → {:.3g}", text.empty() ? "" : "; ", standard[i].name, from, to);
  }
  return text.empty() ? "no change" : text;
}

}  // namespace kinfer::study::thresholds_study
