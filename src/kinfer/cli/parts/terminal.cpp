// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/parts/terminal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <string_view>

namespace kinfer::cli {

bool wants_colours(std::FILE* stream) {
  const char* refusal = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  return isatty(fileno(stream)) != 0 && (refusal == nullptr || *refusal == '\0') && terminal != nullptr &&
         std::string_view(terminal) != "dumb";
}

Tone tone_of(Usability usability) {
  return usability == Usability::use ? Tone::good : usability == Usability::use_with_care ? Tone::neutral : Tone::bad;
}

void print_summary(const std::string& summary, Tone tone) {
  if (!wants_colours(stdout)) {
    fmt::print("{}", summary);
    return;
  }
  const std::string::size_type end = std::min(summary.find('\n'), summary.size());
  const char* colour = tone == Tone::good ? "\033[1;32m" : tone == Tone::bad ? "\033[1;31m" : "\033[1m";
  fmt::print("{}{}\033[0m{}", colour, summary.substr(0, end), summary.substr(end));
}

std::string time_left(double seconds, double fraction) {
  constexpr double min_fraction = 0.02, min_seconds = 0.5;  // fraction of the stage; [s]
  if (!(fraction > min_fraction) || fraction >= 1.0 || seconds < min_seconds) return "";
  const double left = seconds * (1.0 - fraction) / fraction;  // stages may end early
  return left < 90.0 ? fmt::format("  at most {:.0f} s left", std::ceil(left))
                     : fmt::format("  at most {:.0f} min left", std::ceil(left / 60.0));
}

}  // namespace kinfer::cli
