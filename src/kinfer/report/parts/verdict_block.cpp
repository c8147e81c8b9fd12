// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/parts/verdict_block.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kinfer/report/parts/html.hpp"

namespace kinfer::report {
namespace {

/// Colour of the chip, and its text where the file does not hold the parts of the sentence.
struct Chip {
  const char* colour;
  const char* text;
};

Chip chip_of(Usability usability) {
  switch (usability) {
    case Usability::use:
      return {"good", "Use it"};
    case Usability::use_with_care:
      return {"fair", "Use with care"};
    case Usability::do_not_use:
      break;
  }
  return {"bad", "Do not use"};
}

}  // namespace

std::string as_sentence(std::string text) {
  if (!text.empty() && text.front() >= 'a' && text.front() <= 'z') text.front() += 'A' - 'a';
  return text;
}

std::string verdict_block(const VerdictRecord& verdict, const std::string& subject) {
  const Chip chip = chip_of(verdict.usability);
  const VerdictText text = verdict.parts.value_or(VerdictText{chip.text, verdict.sentence, {}});
  const std::string remarks = as_sentence(fmt::format("{}", fmt::join(text.remarks, "; ")));
  return fmt::format(
      "<p class=\"kicker\">{}</p><div id=\"verdict\"><h1><span class=\"chip {}\">{}</span> {}</h1>{}</div>", subject,
      chip.colour, html::escape(text.recommendation), html::prose(as_sentence(text.statement)),
      remarks.empty() ? "" : fmt::format("<p>{}.</p>", html::prose(remarks)));
}

}  // namespace kinfer::report
