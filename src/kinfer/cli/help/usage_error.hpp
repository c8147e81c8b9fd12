// SPDX-License-Identifier: Apache-2.0
// What is wrong with a command line that the library for options refuses, in our words: by the kind of its exception
// and by what it has read, not by its sentence.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace kinfer::cli {

/// "--out: expected DIR after it".
std::string usage_sentence(const CLI::ParseError& refusal, const CLI::App& program,
                           const std::vector<std::string>& arguments);

}  // namespace kinfer::cli
