// SPDX-License-Identifier: Apache-2.0
// Printed rows of the study: target and result.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace kinfer::study {

inline void print_head(const std::string& title) {
  fmt::print("\n{}\n  {:<58} {:>9} {:>9}\n", title, "", "target", "reached");
}

/// `target` NaN: no target. Millimetres unless the name says otherwise.
inline void print_row(const std::string& name, double target, double reached, const std::string& more = "") {
  const std::string limit = std::isnan(target) ? "-" : fmt::format("{:.3f}", target);
  const char* sign = std::isnan(target) ? "" : reached <= target ? "  yes" : "  NO";
  fmt::print("  {:<58} {:>9} {:>9.4f}{}{}{}\n", name, limit, reached, sign, more.empty() ? "" : "   ", more);
}

}  // namespace kinfer::study
