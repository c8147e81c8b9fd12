// What a terminal shows: colours only where they are wanted, and how much time is left.
#pragma once

#include <cstdio>
#include <string>

namespace kinfer::cli {

/// A terminal, and neither NO_COLOR (no-color.org) nor TERM=dumb speaks against colours.
bool wants_colours(std::FILE* stream);

enum class Tone { neutral, good, bad };

/// Prints a summary to stdout; its first line, the verdict, stands out on a terminal.
void print_summary(const std::string& summary, Tone tone);

/// "at most 3 s left", from the time that a fraction took; empty while nothing can be said.
std::string time_left(double seconds, double fraction);

}  // namespace kinfer::cli
