// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/model_formats.hpp"

#include <algorithm>
#include <array>

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/robot/mjcf/mjcf.hpp"
#include "kinfer/io/text/xml_positions.hpp"

namespace kinfer {
namespace {

bool contains(const std::vector<std::string_view>& extensions, std::string_view extension) {
  return std::ranges::find(extensions, extension) != extensions.end();
}

/// "a, b or c"
std::string join_alternatives(const std::vector<std::string_view>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += fmt::format("{}{}", i == 0 ? "" : i + 1 < names.size() ? ", " : " or ", names[i]);
  return text;
}

RobotSource source_of(RobotFileFormat format, const std::string& text, const std::string& name, const ChainEnds& ends) {
  return {format, std::filesystem::path(name).filename().string(), text, ends};
}

/// "<robot> (URDF) or <mujoco> (MJCF)"
std::string readable_root_elements() {
  std::vector<std::string> names;
  for (const ModelFormat& format : model_formats())
    if (format.parse && !format.root_element.empty())
      names.push_back(fmt::format("<{}> ({})", format.root_element, format.name));
  return join_alternatives({names.begin(), names.end()});
}

/// XML by its outermost element, other text by the extension; unknown extensions are the first format.
Result<const ModelFormat*> format_of(const std::filesystem::path& path, const std::string& text) {
  const std::string extension = path.extension().string();
  const std::string_view root = xml_root_name(text);
  std::vector<const ModelFormat*> candidates;
  for (const ModelFormat& format : model_formats()) {
    if (!format.parse) continue;
    if (!root.empty() && format.root_element == root) return &format;
    if (contains(format.read_extensions, extension)) candidates.push_back(&format);
  }
  if (!root.empty() && candidates.size() > 1)
    return error("{}:{}: expected {}, found <{}>", path.string(), 1 + std::count(text.data(), root.data(), '\n'),
                 readable_root_elements(), root);
  return candidates.empty() ? &model_formats().front() : candidates.front();
}

}  // namespace

std::span<const ModelFormat> model_formats() {
  static const std::array formats{
      ModelFormat{
          .name = "TOML",
          .read_extensions = {".toml"},
          .write_extensions = {".toml"},
          .parse = [](const std::string& text, const std::string& name,
                      const ChainEnds&) { return parse_robot_toml(text, name); },
          .format = [](const RobotModel& robot, const StandardDeviations& sd) { return format_robot_toml(robot, sd); }},
      ModelFormat{
          .name = "URDF",
          .read_extensions = {".urdf", ".xml"},
          .write_extensions = {".urdf"},
          .root_element = "robot",
          .parse = [](const std::string& text, const std::string& name, const ChainEnds& ends) -> Result<RobotModel> {
            KINFER_TRY(chain, parse_urdf(text, name, ends));
            RobotModel robot;
            robot.chain = std::move(chain);
            robot.source = source_of(RobotFileFormat::urdf, text, name, ends);
            return robot;
          },
          .format = [](const RobotModel& robot, const StandardDeviations&) { return format_urdf(robot.chain); }},
      ModelFormat{
          .name = "MJCF",
          .read_extensions = {".mjcf", ".xml"},
          .write_extensions = {".mjcf", ".xml"},
          .root_element = "mujoco",
          .parse = [](const std::string& text, const std::string& name, const ChainEnds& ends) -> Result<RobotModel> {
            KINFER_TRY(chain, parse_mjcf(text, name, ends));
            RobotModel robot;
            robot.chain = std::move(chain);
            robot.source = source_of(RobotFileFormat::mjcf, text, name, ends);
            return robot;
          },
          .format = [](const RobotModel& robot, const StandardDeviations&) { return format_mjcf(robot.chain); }},
  };
  return formats;
}

std::string readable_model_formats() {
  std::vector<std::string_view> names;
  for (const ModelFormat& format : model_formats())
    if (format.parse) names.push_back(format.name);
  return join_alternatives(names);
}

std::string writable_model_extensions() {
  std::vector<std::string_view> names;
  for (const ModelFormat& format : model_formats())
    if (format.format) names.push_back(format.write_extensions.front());
  return join_alternatives(names);
}

Result<RobotModel> read_robot_model(const std::filesystem::path& path, const ChainEnds& ends) {
  const std::string extension = path.extension().string();
  if (extension == ".xacro")
    return error("{}: xacro files must be expanded first: xacro {} > robot.urdf", path.string(),
                 path.filename().string());
  KINFER_TRY(text, read_text_file(path));
  KINFER_TRY(format, format_of(path, text));
  auto robot = format->parse(text, path.string(), ends);
  const bool is_guess = xml_root_name(text).empty() && !contains(format->read_extensions, extension);
  if (!robot && is_guess) return error("{}; expected a robot as {}", robot.error().what, readable_model_formats());
  return robot;
}

Result<void> write_robot_model(const std::filesystem::path& path, const RobotModel& robot,
                               const StandardDeviations& sd) {
  const std::string extension = path.extension().string();
  for (const ModelFormat& format : model_formats())
    if (format.format && contains(format.write_extensions, extension))
      return write_text_file(path, format.format(robot, sd));
  return error("{}: expected an ending {}", path.string(), writable_model_extensions());
}

}  // namespace kinfer
