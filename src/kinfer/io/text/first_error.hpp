// SPDX-License-Identifier: Apache-2.0
// The first error found in a file. After an error a reader continues with zeros and checks once, at the end.
#pragma once

#include <string>
#include <utility>

#include "kinfer/base/result.hpp"

namespace kinfer {

class FirstError {
 public:
  explicit FirstError(std::string file) : file_(std::move(file)) {}
  bool any() const { return !sentence_.empty(); }

  /// Stores "file:line: sentence" unless an earlier error is stored.
  void report(int line, const std::string& sentence) {
    if (!any()) sentence_ = fmt::format("{}:{}: {}", file_, line, sentence);
  }
  Error as_error() const { return {sentence_}; }

 private:
  std::string file_, sentence_;
};

}  // namespace kinfer
