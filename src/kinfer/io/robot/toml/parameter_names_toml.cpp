// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/toml/parameter_names_toml.hpp"

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/text/toml_reader.hpp"

namespace kinfer {

Result<std::vector<std::string>> read_parameter_names(const std::filesystem::path& path) {
  KINFER_TRY(text, read_text_file(path));
  const std::string name = path.filename().string();
  KINFER_TRY(table, parse_toml(text, name));
  const TomlValue* list = table.find("parameters");
  const auto* array = list ? std::get_if<TomlArray>(&list->value) : nullptr;
  if (!array || array->empty()) return error("{}: expected parameters = [\"a2\", \"theta3\", ...]", name);
  std::vector<std::string> names;
  for (const TomlValue& value : *array) {
    const auto* word = std::get_if<std::string>(&value.value);
    if (!word) return error("{}:{}: parameters: expected names in quotes", name, value.line);
    names.push_back(*word);
  }
  return names;
}

}  // namespace kinfer
