// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/help/man_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>

#include "kinfer/cli/help/help_text.hpp"

namespace kinfer::cli {
namespace {

/// Backslashes and hyphens as they are, and no line that begins with a request of roff.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else if ((c == '.' || c == '\'') && (result.empty() || result.back() == '\n')) {
      result += std::string("\\&") + c;
    } else {
      result += c;
    }
  }
  return result;
}

std::string head(const std::string& page, const std::string& summary, const std::string& version) {
  std::string upper = page;
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return fmt::format(".TH {} 1 \"\" \"kinfer {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n", escaped(upper), version,
                     escaped(page), escaped(summary));
}

std::string option_paragraph(const OptionEntry& option) {
  std::string text = fmt::format(".TP\n.B {}\n{}", escaped(option_usage(option)), escaped(option.help));
  if (option.required) text += " (required)";
  if (!option.default_value.empty()) text += fmt::format(" [default: {}]", escaped(option.default_value));
  return text + "\n";
}

/// Text with its examples, whose lines are indented, as they are.
std::string footer_section(const std::string& footer) {
  std::istringstream lines(footer);
  std::string text = ".SH EXAMPLES\n";
  bool literal = false;
  for (std::string line; std::getline(lines, line);) {
    const bool is_example = line.starts_with("  ");
    if (is_example != literal) text += is_example ? ".PP\n.nf\n" : ".fi\n.PP\n";
    literal = is_example;
    text += escaped(line) + "\n";
  }
  return text + (literal ? ".fi\n" : "");
}

constexpr const char* exit_codes =
    ".SH EXIT STATUS\n.TP\n.B 0\ndone\n.TP\n.B 1\ndone, files written, but the result must not be used, or something "
    "was not reached\n.TP\n.B 2\nbad input or usage, nothing written; or standard output cannot be written: result "
    "files stay\n.TP\n.B 3\ninternal error\n";

}  // namespace

std::string man_page(const VerbEntry& verb, const std::string& version) {
  std::string text = head("kinfer-" + verb.name, verb.summary, version);
  text += fmt::format(".SH SYNOPSIS\n.B {}\n.SH OPTIONS\n", escaped(usage_line(verb)));
  for (const std::string& group : groups_of(verb)) {
    text += fmt::format(".SS {}\n", escaped(group));
    for (const OptionEntry& option : verb.options)
      if ((option.required ? "Required" : option.group) == group) text += option_paragraph(option);
  }
  return text + footer_section(verb.footer) + exit_codes + ".SH SEE ALSO\n.BR kinfer (1)\n";
}

std::string man_page(const ProgramEntry& program, const std::string& version) {
  std::string text = head("kinfer", "from raw measurements to a proven kinematic model", version);
  text += ".SH SYNOPSIS\n.B kinfer\n.I VERB\n[OPTIONS]\n.SH VERBS\n";
  for (const VerbEntry& verb : program.verbs)
    text += fmt::format(".TP\n.BR {} (1)\n{}\n", escaped("kinfer-" + verb.name), escaped(verb.summary));
  text += ".SH OPTIONS\n";
  for (const OptionEntry& option : program.program.options) text += option_paragraph(option);
  return text + exit_codes;
}

}  // namespace kinfer::cli
