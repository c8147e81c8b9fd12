// SPDX-License-Identifier: Apache-2.0
// Terminal output: colours and the estimate of the time left.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "kinfer/evidence/facts/verdict.hpp"

namespace kinfer::cli {

/// The text with "?" for what would command a terminal instead of being shown: control characters but line ends and
/// tabs, and Unicode's marks that reverse the direction of writing. Names in it come from files of strangers.
std::string printable(std::string_view text);

/// True if the stream is a terminal and neither NO_COLOR (no-color.org) nor TERM=dumb is set.
bool wants_colours(std::FILE* stream);

enum class Tone { neutral, good, bad };
Tone tone_of(Usability usability);

/// Prints a summary to stdout; its first line, the verdict, is highlighted on a terminal.
void print_summary(const std::string& text, Tone tone);

/// "at most 3 s left", extrapolated from the finished fraction; empty while it is too early to tell.
std::string time_left(double seconds, double fraction);

}  // namespace kinfer::cli
