// The first thing that was wrong with a file: a reader goes on with zeros and looks once, at the end.
#pragma once

#include <string>
#include <utility>

#include "kinfer/base/result.hpp"

namespace kinfer {

class Complaint {
 public:
  explicit Complaint(std::string file) : file_(std::move(file)) {}
  bool any() const { return !sentence_.empty(); }

  /// Keeps "file:line: sentence" unless something was wrong before.
  void say(int line, const std::string& sentence) {
    if (!any()) sentence_ = fmt::format("{}:{}: {}", file_, line, sentence);
  }
  Error as_error() const { return {sentence_}; }

 private:
  std::string file_, sentence_;
};

}  // namespace kinfer
