// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/options/orientation_hypotheses.hpp"

namespace kinfer::cli {
namespace {

std::vector<std::string> sequences() {
  std::vector<std::string> names;
  for (const char* kind : {" intrinsic", " extrinsic"})
    for (const char* axes : {"XYZ", "ZYX", "ZXY", "YXZ", "XZY", "YZX", "ZYZ", "ZXZ", "XYX", "XZX", "YXY", "YZY"})
      names.push_back(std::string(axes) + kind);
  return names;
}

/// The column map with another unit for the angles: "theirs [deg]".
ColumnMap with_angle_unit(ColumnMap map, const std::string& unit) {
  for (auto& [ours, theirs] : map.columns)
    if (ours == "rx" || ours == "ry" || ours == "rz")
      theirs = fmt::format("{}[{}]", theirs.substr(0, theirs.find('[')), unit);
  return map;
}

}  // namespace

std::vector<calibrate::OrientationInterpretation> orientation_hypotheses(const std::string& file, const Chain& chain,
                                                                         const ColumnMap& map) {
  std::vector<calibrate::OrientationInterpretation> interpretations;
  if (!map.euler) return interpretations;
  for (const char* unit : {"deg", "rad"})
    for (const std::string& sequence : sequences()) {
      ColumnMap other = with_angle_unit(map, unit);
      other.euler = parse_euler_sequence(sequence);
      const auto set = read_pose_set(file, chain, other);
      if (!set) continue;
      interpretations.push_back({{{"euler", sequence}, {"unit", std::string(unit)}}, set->orientations});
    }
  return interpretations;
}

}  // namespace kinfer::cli
