// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/foreign/ins_presets.hpp"

#include <algorithm>

#include "kinfer/base/expect.hpp"
#include "kinfer/io/recording/foreign/log_columns.hpp"
#include "kinfer/io/recording/foreign/preset_files.hpp"

namespace kinfer {
namespace {

bool recognises(const InsMap& preset, std::string_view head, const std::string& stem) {
  if (!preset.unlike.empty() && head.find(preset.unlike) != std::string_view::npos) return false;
  return stem.find(preset.file_word) != std::string::npos && !preset.recognise.empty() &&
         std::ranges::all_of(preset.recognise,
                             [&](const std::string& text) { return head.find(text) != std::string_view::npos; });
}

/// How much a preset asks for.
std::size_t specificity(const InsMap& preset) {
  std::size_t letters = preset.file_word.size();
  for (const std::string& text : preset.recognise) letters += text.size();
  return letters;
}

}  // namespace

std::span<const InsMap> ins_presets() {
  static const std::vector<InsMap> presets = [] {
    std::vector<InsMap> list;
    for (const PresetFile& file : preset_files()) {
      auto map = parse_ins_map(file.toml, std::string(file.name));
      KINFER_EXPECT(map.has_value(), "preset {}: {}", file.name, map.has_value() ? "" : map.error().what);
      list.push_back(std::move(*map));
    }
    return list;
  }();
  return presets;
}

const InsMap* find_preset(std::string_view head, const std::filesystem::path& path) {
  const std::string stem = path.stem().string();
  const InsMap* best = nullptr;
  for (const InsMap& preset : ins_presets())
    if (recognises(preset, head, stem) && (!best || specificity(preset) > specificity(*best))) best = &preset;
  return best;
}

bool is_foreign_log(std::string_view head) {
  const InsMap guess;
  const auto header = read_csv_header(head, "", guess.format);
  return header && find_log_columns(*header, head.substr(0, header->body), guess, "").has_value();
}

}  // namespace kinfer
