// SPDX-License-Identifier: Apache-2.0
#include "fuzz_commands/command.hpp"

#include <algorithm>
#include <fstream>
#include <set>

#include "fuzz_commands/material.hpp"
#include "fuzz_commands/mutation.hpp"
#include "fuzz_commands/process.hpp"

namespace kinfer::fuzz {
namespace {

namespace fs = std::filesystem;

/// [s] What takes longer, such as a million poses, must end with a sentence.
constexpr const char* limit_time = "5";

const Recipe& draw_recipe(Rng& rng) {
  std::uint64_t all = 0;
  for (const Recipe& recipe : recipes()) all += static_cast<std::uint64_t>(recipe.weight);
  std::uint64_t at = rng.index(all);
  for (const Recipe& recipe : recipes()) {
    if (at < static_cast<std::uint64_t>(recipe.weight)) return recipe;
    at -= static_cast<std::uint64_t>(recipe.weight);
  }
  return recipes().front();
}

/// Sets an option of the verb, or adds it.
void set_option(const FuzzedVerb& verb, std::vector<std::string>& words, Rng& rng) {
  if (verb.options.empty()) return;
  const FuzzedOption& option = verb.options[rng.index(verb.options.size())];
  if (option.name == "--follow" || option.name == "--threads" || option.name == "--workers") return;
  const auto given = std::ranges::find(words, option.name);
  if (option.placeholder.empty()) {
    words.push_back(option.name);
  } else if (given != words.end() && given + 1 != words.end()) {
    *(given + 1) = draw_value(option, rng);
  } else {
    words.push_back(option.name), words.push_back(draw_value(option, rng));
  }
}

/// Copies what the words name; `evidence.json` and the like are inside of folders.
std::vector<fs::path> copy_inputs(const std::vector<std::string>& words, const fs::path& material,
                                  const fs::path& folder) {
  std::vector<fs::path> files;
  const std::set<std::string> named(words.begin(), words.end());
  for (const std::string& word : named) {
    std::error_code ignored;
    if (word.empty() || word.front() == '/' || word.find("..") != std::string::npos) continue;
    if (!fs::exists(material / word, ignored)) continue;
    fs::create_directories((folder / word).parent_path());
    fs::copy(material / word, folder / word, fs::copy_options::recursive, ignored);
    if (fs::is_regular_file(folder / word)) files.push_back(folder / word);
    for (const char* inner : {"evidence.json", "chain.toml", "track.toml"})
      if (fs::is_regular_file(folder / word / inner)) files.push_back(folder / word / inner);
  }
  if (named.contains("manifest.csv"))
    for (const char* name : {"robot.toml", "short.csv"})
      fs::copy_file(material / name, folder / name, fs::copy_options::skip_existing);
  return files;
}

}  // namespace

FuzzedCommand draw_command(const std::vector<FuzzedVerb>& verbs, const fs::path& material, const fs::path& folder,
                           Rng& rng) {
  const Recipe& recipe = draw_recipe(rng);
  FuzzedCommand command{.words = {"--limit-time", limit_time, recipe.verb}, .changed = {}};
  command.words.insert(command.words.end(), recipe.words.begin(), recipe.words.end());
  const auto verb = std::ranges::find(verbs, recipe.verb, &FuzzedVerb::name);
  for (std::uint64_t options = rng.index(4); options > 0 && verb != verbs.end(); --options)
    set_option(*verb, command.words, rng);
  if (rng.index(20) == 0)
    command.words.erase(command.words.begin() + static_cast<std::ptrdiff_t>(rng.index(command.words.size())));
  const std::vector<fs::path> files = copy_inputs(command.words, material, folder);
  for (std::uint64_t changes = rng.index(3); changes > 0 && !files.empty(); --changes) {
    const fs::path& file = files[rng.index(files.size())];
    const std::string text = mutate(read_bytes(file), rng);
    std::ofstream(file, std::ios::binary | std::ios::trunc) << text;
    command.changed += text;
  }
  return command;
}

}  // namespace kinfer::fuzz
