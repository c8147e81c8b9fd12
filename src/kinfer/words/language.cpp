// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/language.hpp"

#include <atomic>

namespace kinfer::words {
namespace {

std::atomic<Language> current{Language::english};

}  // namespace

void set_language(Language language) {
  current = language;
}

Language language() {
  return current;
}

}  // namespace kinfer::words
