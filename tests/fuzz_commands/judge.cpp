// SPDX-License-Identifier: Apache-2.0
#include "fuzz_commands/judge.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cctype>
#include <regex>

#include "kinfer/io/evidence/evidence_file.hpp"
#include "kinfer/io/robot/mjcf/mjcf.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"
#include "kinfer/io/robot/urdf/urdf.hpp"

namespace kinfer::fuzz {
namespace {

namespace fs = std::filesystem;

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// The first "nan" or "inf" that stands alone, as a formatted number does, and is no quotation ("expected 'inf'").
std::string number_that_is_none(const std::string& text) {
  const auto is_letter = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '\'' || c == '"';
  };
  for (const char* word : {"nan", "inf"})
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
      const bool begins = at == 0 || !is_letter(text[at - 1]);
      const bool ends = at + 3 >= text.size() || !is_letter(text[at + 3]);
      if (begins && ends) return word;
    }
  return {};
}

void judge_ending(const ProcessResult& run, std::vector<std::string>& broken) {
  if (run.timed_out)
    broken.push_back("it does not end in time");
  else if (run.signal != 0)
    broken.push_back(fmt::format("ended by signal {}", run.signal));
  else if (run.code > 2)
    broken.push_back(fmt::format("exit code {}", run.code));
}

void judge_text(const ProcessResult& run, const std::string& given, std::vector<std::string>& broken) {
  constexpr std::ptrdiff_t most_lines = 12;  // remarks come before the sentence, usage after it
  static const std::regex source_path(R"(\.(cpp|hpp):[0-9]+)");
  if (run.code == 2 && run.err.find_first_not_of(" \n") == std::string::npos)
    broken.push_back("exit code 2 without a sentence");
  if (run.code == 2 && std::ranges::count(run.err, '\n') > most_lines)
    broken.push_back("more than a sentence on standard error");
  if (run.err.find("internal error") != std::string::npos) broken.push_back("\"internal error\"");
  if (run.err.find("runtime error:") != std::string::npos) broken.push_back("a sanitizer's report");
  if (std::regex_search(run.err, source_path)) broken.push_back("a path of the source");
  const std::string said = number_that_is_none(run.err + "\n" + run.out);
  if (!said.empty() && given.find(said) == std::string::npos) broken.push_back("it prints \"" + said + "\"");
}

bool is_well_formed_xml(const std::string& text) {
  const bool has_control_character = std::ranges::any_of(
      text, [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' && c != '\r'; });
  tinyxml2::XMLDocument document;
  return !has_control_character && document.Parse(text.data(), text.size()) == tinyxml2::XML_SUCCESS;
}

void judge_file(const fs::path& path, std::vector<std::string>& broken) {
  const std::string name = path.filename().string(), text = read_bytes(path);
  const auto complain = [&](const std::string& what) { broken.push_back(name + ": " + what); };
  if (name == "chain.toml" || name == "truth.toml" || name == "robot.toml" || name == "out.toml") {
    if (const auto robot = parse_robot_toml(text, name); !robot) complain("cannot be read: " + robot.error().what);
    if (!number_that_is_none(text).empty() && text.find("limits") == std::string::npos)
      complain("has a number that is none");
  }
  if (name.ends_with(".urdf"))
    if (const auto chain = parse_urdf(text, name, {}); !chain) complain("cannot be read: " + chain.error().what);
  if (name.ends_with(".mjcf") || name.ends_with("_calibrated.xml"))
    if (const auto chain = parse_mjcf(text, name); !chain) complain("cannot be read: " + chain.error().what);
  const bool is_users = name.find("_calibrated.") != std::string::npos;  // its other bytes are as they came
  if (!is_users && (name.ends_with(".urdf") || name.ends_with(".mjcf"))) {
    if (!is_well_formed_xml(text)) complain("is not well-formed");
    if (!number_that_is_none(lower(text)).empty()) complain("has a number that is none");
  }
  if (name == "evidence.json")
    if (const auto evidence = read_evidence(text); !evidence) complain("cannot be read: " + evidence.error().what);
}

bool is_output(const fs::path& path) {
  const std::string name = path.filename().string();
  return path.parent_path().filename() == "out" || name.starts_with("out.");
}

}  // namespace

std::vector<std::string> broken_promises(const ProcessResult& run, const std::vector<std::string>& words,
                                         const std::string& inputs, const fs::path& folder) {
  std::vector<std::string> broken;
  judge_ending(run, broken);
  judge_text(run, lower(fmt::format("{} {}", fmt::join(words, " "), inputs)), broken);
  const bool may_be_unfinished = run.signal != 0;
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    const bool is_left = name.ends_with(".unfinished") || name.find(".kinfer-") != std::string::npos;
    if (is_left && !may_be_unfinished) broken.push_back(name + ": left behind");
    if (entry.is_regular_file() && is_output(entry.path()) && !may_be_unfinished) judge_file(entry.path(), broken);
  }
  return broken;
}

}  // namespace kinfer::fuzz
