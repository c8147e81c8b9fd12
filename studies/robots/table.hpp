// SPDX-License-Identifier: Apache-2.0
// The rows that the study prints: what was asked, what was reached.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace kinfer::study {

inline void print_head(const std::string& title) {
  fmt::print("\n{}\n  {:<58} {:>9} {:>9}\n", title, "", "asked", "reached");
}

/// `asked` NaN: only told. Millimetres unless the name says otherwise.
inline void print_row(const std::string& name, double asked, double reached, const std::string& more = "") {
  const std::string limit = std::isnan(asked) ? "-" : fmt::format("{:.3f}", asked);
  const char* sign = std::isnan(asked) ? "" : reached <= asked ? "  yes" : "  NO";
  fmt::print("  {:<58} {:>9} {:>9.4f}{}{}{}\n", name, limit, reached, sign, more.empty() ? "" : "   ", more);
}

}  // namespace kinfer::study
