// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/model_formats.hpp"

#include <algorithm>
#include <array>

#include "kinfer/io/robot/mjcf.hpp"
#include "kinfer/io/text/text_file.hpp"

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

}  // namespace

std::span<const ModelFormat> model_formats() {
  static const std::array formats{
      ModelFormat{
          .name = "TOML",
          .read_extensions = {".toml"},
          .write_extensions = {".toml"},
          .parse = [](const std::string& text, const std::string& name,
                      const UrdfEnds&) { return parse_robot_toml(text, name); },
          .format = [](const RobotModel& robot, const StandardDeviations& sd) { return format_robot_toml(robot, sd); }},
      ModelFormat{
          .name = "URDF",
          .read_extensions = {".urdf", ".xml"},
          .write_extensions = {".urdf"},
          .parse = [](const std::string& text, const std::string& name, const UrdfEnds& ends) -> Result<RobotModel> {
            KINFER_TRY(chain, parse_urdf(text, name, ends));
            RobotModel robot;
            robot.chain = std::move(chain);
            robot.source = {std::filesystem::path(name).filename().string(), text, ends.base_link, ends.tip_link};
            return robot;
          },
          .format = [](const RobotModel& robot, const StandardDeviations&) { return format_urdf(robot.chain); }},
      ModelFormat{
          .name = "MJCF",
          .write_extensions = {".mjcf", ".xml"},
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

Result<RobotModel> read_robot_model(const std::filesystem::path& path, const UrdfEnds& ends) {
  const std::string extension = path.extension().string();
  if (extension == ".xacro")
    return error("{}: xacro files must be expanded first: xacro {} > robot.urdf", path.string(),
                 path.filename().string());
  const ModelFormat* chosen = &model_formats().front();
  for (const ModelFormat& format : model_formats()) {
    if (format.parse && contains(format.read_extensions, extension)) {
      chosen = &format;
      break;
    }
    if (!format.parse && contains(format.write_extensions, extension))
      return error("{}: {} files are written, not read; expected {}", path.string(), format.name,
                   readable_model_formats());
  }
  KINFER_TRY(text, read_text_file(path));
  return chosen->parse(text, path.string(), ends);
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
