// SPDX-License-Identifier: Apache-2.0
// Terminal output: colours and the estimate of the time left.
#pragma once

#include <cstdio>
#include <string>

#include "kinfer/evidence/facts/verdict.hpp"

namespace kinfer::cli {

/// True if the stream is a terminal and neither NO_COLOR (no-color.org) nor TERM=dumb is set.
bool wants_colours(std::FILE* stream);

enum class Tone { neutral, good, bad };
Tone tone_of(Usability usability);

/// Prints a summary to stdout; its first line, the verdict, is highlighted on a terminal.
void print_summary(const std::string& summary, Tone tone);

/// "at most 3 s left", extrapolated from the finished fraction; empty while it is too early to tell.
std::string time_left(double seconds, double fraction);

}  // namespace kinfer::cli
