// SPDX-License-Identifier: Apache-2.0
// In which words facts are told: English, or the stable names of the facts themselves, for programs that read the
// output, for translators, and for the test that no decision depends on a sentence.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

namespace kinfer::words {

enum class Language { english, names };

/// The language of every sentence made from now on, by any thread; set once, at the start of a program.
void set_language(Language language);
Language language();

/// The sentence of a fact: its format filled in, or its name alone where the language is names.
template <class... Args>
std::string phrase(std::string_view name, fmt::format_string<Args...> text, Args&&... args) {
  return language() == Language::names ? std::string(name) : fmt::format(text, std::forward<Args>(args)...);
}

}  // namespace kinfer::words
