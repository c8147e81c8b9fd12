// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/toml/standard_deviations_toml.hpp"

#include <cmath>

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/text/toml_reader.hpp"

namespace kinfer {
namespace {

double unit_factor(const TomlTable& file, std::string_view key) {
  const TomlValue* units = file.find("units");
  const auto* table = units ? std::get_if<TomlTable>(&units->value) : nullptr;
  const TomlValue* entry = table ? table->find(key) : nullptr;
  const auto* text = entry ? std::get_if<std::string>(&entry->value) : nullptr;
  const auto unit = text ? find_unit(*text) : std::nullopt;
  return unit ? unit->factor : 1.0;
}

struct Reader {
  double length, angle;
  StandardDeviations sd;

  void read_number(const TomlTable& row, std::size_t index, const std::string& name, double factor) {
    const TomlValue* value = row.find(name + "_sd");
    const auto* number = value ? std::get_if<double>(&value->value) : nullptr;
    if (number && std::isfinite(*number)) sd[fmt::format("{}{}", name, index)] = *number * factor;
  }

  void read_vector(const TomlTable& row, std::size_t index, const std::string& key, const char* prefix, double factor) {
    const TomlValue* value = row.find(key);
    const auto* list = value ? std::get_if<TomlArray>(&value->value) : nullptr;
    for (std::size_t k = 0; list && k < list->size() && k < 3; ++k)
      if (const auto* number = std::get_if<double>(&(*list)[k].value); number && std::isfinite(*number))
        sd[fmt::format("{}{}{}", prefix, "xyz"[k], index)] = *number * factor;
  }

  void read_joint(const TomlTable& row, std::size_t index) {
    for (const char* name : {"a", "d"}) read_number(row, index, name, length);
    for (const char* name : {"alpha", "theta", "beta"}) read_number(row, index, name, angle);
    for (const char* name : {"gain", "compliance"}) read_number(row, index, name, 1.0);
    read_vector(row, index, "xyz_sd", "", length);
    read_vector(row, index, "turn_sd", "r", angle);
  }
};

}  // namespace

Result<StandardDeviations> read_standard_deviations(const std::filesystem::path& path) {
  KINFER_TRY(text, read_text_file(path));
  KINFER_TRY(file, parse_toml(text, path.string()));
  Reader reader{unit_factor(file, "length"), unit_factor(file, "angle"), {}};
  const TomlValue* joints = file.find("joint");
  const auto* rows = joints ? std::get_if<TomlArray>(&joints->value) : nullptr;
  for (std::size_t i = 0; rows && i < rows->size(); ++i)
    if (const auto* row = std::get_if<TomlTable>(&(*rows)[i].value)) reader.read_joint(*row, i + 1);
  return reader.sd;
}

}  // namespace kinfer
