// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/parts/terminal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "kinfer/io/text/quoted_text.hpp"

namespace kinfer::cli {

namespace {

bool is_output_closed = false, is_lost = false;

/// fmt throws where the stream takes no more, as the program expects; std::fwrite would not.
void print_bytes(std::FILE* stream, std::string_view bytes) {
  fmt::print(stream, "{}", bytes);
}

/// One character of UTF-8: a control character, or one that turns the direction of writing.
bool commands_terminal(std::string_view character) {
  const auto byte = [&](std::size_t k) { return k < character.size() ? static_cast<unsigned char>(character[k]) : 0U; };
  const bool is_control = (byte(0) < 0x20 && byte(0) != '\n' && byte(0) != '\t') || byte(0) == 0x7F;
  const bool is_control_of_two = byte(0) == 0xC2 && byte(1) < 0xA0;  // U+0080 to U+009F
  const bool is_direction =                                          // U+200E, 200F, 202A to 202E, 2066 to 2069
      byte(0) == 0xE2 &&
      ((byte(1) == 0x80 && (byte(2) == 0x8E || byte(2) == 0x8F || (byte(2) >= 0xAA && byte(2) <= 0xAE))) ||
       (byte(1) == 0x81 && byte(2) >= 0xA6 && byte(2) <= 0xA9));
  return is_control || is_control_of_two || is_direction;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    // A byte that is no UTF-8 may be a control character of another character set.
    const std::size_t size = utf8_character_size(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(1, size));
    if (size == 0 || commands_terminal(character))
      shown += '?';
    else
      shown += character;
    text.remove_prefix(character.size());
  }
  return shown;
}

void print_printable(std::FILE* stream, std::string_view text) {
  print_bytes(stream, printable(text));
}

void print_data(std::string_view text) {
  if (is_output_closed && !text.empty()) is_lost = true;
  print_bytes(stdout, text);
}

void expect_no_data() {
  is_output_closed = true;
}

bool is_data_lost() {
  return is_lost;
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
