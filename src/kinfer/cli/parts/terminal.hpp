// SPDX-License-Identifier: Apache-2.0
// What the program prints: prose and data, colours, and the estimate of the time left.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include "kinfer/evidence/facts/verdict.hpp"

namespace kinfer::cli {

/// The text with "?" for what would command a terminal instead of being shown: control characters but line ends and
/// tabs, and Unicode's marks that reverse the direction of writing. Names in it come from files of strangers.
std::string printable(std::string_view text);

void print_printable(std::FILE* stream, std::string_view text);

/// Prose to standard output; printable, whatever the names in it. All prose of the program is printed by this function,
/// print_message, print_progress or print_summary.
template <class... Values>
void print_text(fmt::format_string<Values...> format, Values&&... values) {
  print_printable(stdout, fmt::format(format, std::forward<Values>(values)...));
}

/// Prose to standard error.
template <class... Values>
void print_message(fmt::format_string<Values...> format, Values&&... values) {
  print_printable(stderr, fmt::format(format, std::forward<Values>(values)...));
}

/// CSV, JSON and scripts to standard output, byte for byte.
void print_data(std::string_view text);
/// Standard output was closed before the program began: sentences may go nowhere, results may not.
void expect_no_data();
/// Whether results went to a closed standard output.
bool is_data_lost();

/// Replaces the line of progress on standard error; an empty one erases it.
void print_progress(std::string_view line);

/// True if the stream is a terminal and neither NO_COLOR (no-color.org) nor TERM=dumb is set.
bool wants_colours(std::FILE* stream);

enum class Tone { neutral, good, bad };
Tone tone_of(Usability usability);

/// Prints a summary to stdout; its first line, the verdict, is highlighted on a terminal.
void print_summary(const std::string& text, Tone tone);

/// "at most 3 s left", extrapolated from the finished fraction; empty while it is too early to tell.
std::string time_left(double seconds, double fraction);

}  // namespace kinfer::cli
