// SPDX-License-Identifier: Apache-2.0
// The program as a function, for a verb that runs other verbs.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace kinfer::cli {

/// All verbs and options described, which takes as long as a small task: a sweep does it once, and each of its
/// processes runs a copy.
class Program {
 public:
  Program();
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Runs `kinfer arguments`, once; returns its exit code.
  int run(const std::vector<std::string>& arguments);

 private:
  struct Description;
  std::unique_ptr<Description> description_;
};

/// Columns of the terminal that the text is printed to, 60 to 120; 100 where it is none.
std::size_t terminal_width();

}  // namespace kinfer::cli
