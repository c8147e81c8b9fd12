// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/patch/placement_toml.hpp"

#include <fmt/format.h>

#include "kinfer/io/text/format_number.hpp"
#include "kinfer/io/text/quoted_text.hpp"

namespace kinfer {
namespace {

std::string toml_numbers(std::initializer_list<double> values) {
  std::string text = "[";
  for (const double value : values) text += (text.size() > 1 ? ", " : "") + format_number(value + 0.0);
  return text + "]";
}

std::string toml_numbers(const Vec3& v) {
  return toml_numbers({v.x(), v.y(), v.z()});
}

class PlacementWriter {
 public:
  explicit PlacementWriter(const StandardDeviations& sd) : sd_(sd) {}

  /// `suffix` of the parameter names: "@left" of a mounting.
  std::string frame(const std::string& table, const std::string& link, const Frame& frame,
                    const std::string& suffix = "") const {
    const Pose pose = frame.pose();
    const Quat q(pose.rotation);
    std::string text = link.empty() ? "" : fmt::format("link = {}\n", quoted_text(link));
    text += fmt::format("xyz = {}\nrpy = {}\nquaternion = {}  # w, x, y, z\n", toml_numbers(pose.position),
                        toml_numbers(to_rpy(pose.rotation)), toml_numbers({q.w(), q.x(), q.y(), q.z()}));
    return text + deviations(table + "_", "", "xyz_sd", suffix) + deviations(table + "_", "r", "turn_sd", suffix);
  }

 private:
  std::string deviations(const std::string& prefix, const char* turn, const char* key,
                         const std::string& suffix) const {
    Vec3 values = Vec3::Zero();
    bool any = false;
    for (int k = 0; k < 3; ++k)
      if (const auto found = sd_.find(fmt::format("{}{}{}{}", prefix, turn, "xyz"[k], suffix)); found != sd_.end())
        values[k] = found->second, any = true;
    return any ? fmt::format("{} = {}\n", key, toml_numbers(values)) : "";
  }

  const StandardDeviations& sd_;
};

}  // namespace

std::string format_placement_toml(const Chain& chain, const ChainEnds& ends, const StandardDeviations& sd) {
  const PlacementWriter writer(sd);
  std::string text =
      "# Where the robot stands and what it carries, as calibrated; lengths in m, angles in rad.\n"
      "# base: pose of the link in the frame of the measurements. tool: pose of the tool in the frame of the link.\n"
      "# R = Rz(yaw) Ry(pitch) Rx(roll); _sd: one standard deviation, of the rotation about the axes of the frame.\n";
  if (!chain.setup.empty()) text += fmt::format("setup = {}\n", quoted_text(chain.setup));
  text += "\n[base]\n" + writer.frame("base", ends.base_link, chain.base);
  text += "\n[tool]\n" + writer.frame("tool", ends.tip_link, chain.tool);
  for (const Target& target : chain.targets)
    text += fmt::format("\n[[target]]  # on the tool\nname = {}\nxyz = {}\n", quoted_text(target.name),
                        toml_numbers(target.xyz));
  for (const RobotMounting& mounting : chain.mountings) {
    const std::string suffix = "@" + mounting.name;
    text += fmt::format("\n[[mounting]]\nname = {}\n", quoted_text(mounting.name));
    if (mounting.base) text += "[mounting.base]\n" + writer.frame("base", ends.base_link, *mounting.base, suffix);
    text += "[mounting.tool]\n" + writer.frame("tool", mounting.tip < 0 ? ends.tip_link : "", mounting.tool, suffix);
  }
  return text;
}

}  // namespace kinfer
