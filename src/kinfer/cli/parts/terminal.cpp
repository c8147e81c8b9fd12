// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/parts/terminal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <string_view>

namespace kinfer::cli {

namespace {

/// fmt throws where the stream takes no more, as the program expects; std::fwrite would not.
void print_bytes(std::FILE* stream, std::string_view bytes) {
  fmt::print(stream, "{}", bytes);
}

}  // namespace

std::string printable(std::string_view text) {
  std::string shown;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = [&](std::size_t ahead) {
      return i + ahead < text.size() ? static_cast<unsigned char>(text[i + ahead]) : 0U;
    };
    const bool is_control = (byte(0) < 0x20 && text[i] != '\n' && text[i] != '\t') || byte(0) == 0x7F;
    const bool is_control_of_two = byte(0) == 0xC2 && byte(1) >= 0x80 && byte(1) < 0xA0;  // U+0080 to U+009F
    const bool is_direction =  // U+200E, 200F, 202A to 202E, 2066 to 2069
        byte(0) == 0xE2 &&
        ((byte(1) == 0x80 && (byte(2) == 0x8E || byte(2) == 0x8F || (byte(2) >= 0xAA && byte(2) <= 0xAE))) ||
         (byte(1) == 0x81 && byte(2) >= 0xA6 && byte(2) <= 0xA9));
    if (is_control || is_control_of_two || is_direction)
      shown += '?';
    else
      shown += text[i];
    i += is_direction ? 2 : is_control_of_two ? 1 : 0;
  }
  return shown;
}

void print_printable(std::FILE* stream, std::string_view text) {
  print_bytes(stream, printable(text));
}

void print_data(std::string_view text) {
  print_bytes(stdout, text);
}

void print_progress(std::string_view line) {
  print_bytes(stderr, "\r\033[K" + printable(line));
  std::fflush(stderr);
}

bool wants_colours(std::FILE* stream) {
  const char* refusal = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  return isatty(fileno(stream)) != 0 && (refusal == nullptr || *refusal == '\0') && terminal != nullptr &&
         std::string_view(terminal) != "dumb";
}

Tone tone_of(Usability usability) {
  return usability == Usability::use ? Tone::good : usability == Usability::use_with_care ? Tone::neutral : Tone::bad;
}

void print_summary(const std::string& text, Tone tone) {
  const std::string summary = printable(text);
  if (!wants_colours(stdout)) {
    print_bytes(stdout, summary);
    return;
  }
  const std::string::size_type end = std::min(summary.find('\n'), summary.size());
  const char* colour = tone == Tone::good ? "\033[1;32m" : tone == Tone::bad ? "\033[1;31m" : "\033[1m";
  print_bytes(stdout, colour + summary.substr(0, end) + "\033[0m" + summary.substr(end));
}

std::string time_left(double seconds, double fraction) {
  constexpr double min_fraction = 0.02, min_seconds = 0.5;  // fraction of the stage; [s]
  if (!(fraction > min_fraction) || fraction >= 1.0 || seconds < min_seconds) return "";
  const double left = seconds * (1.0 - fraction) / fraction;  // stages may end early
  return left < 90.0 ? fmt::format("  at most {:.0f} s left", std::ceil(left))
                     : fmt::format("  at most {:.0f} min left", std::ceil(left / 60.0));
}

}  // namespace kinfer::cli
