// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/toml/robot_toml.hpp"

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/robot/model/possible_chain.hpp"
#include "kinfer/io/robot/toml/displacement_field_toml.hpp"
#include "kinfer/io/robot/toml/fixtures_toml.hpp"
#include "kinfer/io/robot/toml/instrument_toml.hpp"
#include "kinfer/io/robot/toml/joints_toml.hpp"
#include "kinfer/io/robot/toml/prediction_toml.hpp"

namespace kinfer {
namespace {

std::vector<PointMass> read_masses(TableReader& file, int joints, const Scales& scales, FirstError& first_error) {
  std::vector<PointMass> masses;
  for (const auto& [table, line] : file.tables_or_none("mass")) {
    TableReader row(*table, line, fmt::format("mass {}: ", masses.size() + 1), first_error);
    const double link = row.number("link");
    const bool known = link >= 1 && link <= joints && link == static_cast<int>(link);
    if (row.has("link") && !known)
      row.report_error(row.line_of("link"), fmt::format("\"link\": expected a whole number from 1 to {}", joints));
    const double mass = row.number("mass");
    if (mass < 0) row.report_error(row.line_of("mass"), "\"mass\": expected a number from 0");
    masses.push_back({known ? static_cast<int>(link) - 1 : 0, row.vector("com") * scales.length, mass});
    row.expect_no_other_keys();
  }
  return masses;
}

}  // namespace

Result<RobotModel> parse_robot_toml(std::string_view text, const std::string& name) {
  KINFER_TRY(table, parse_toml(text, name));
  FirstError first_error(name);
  TableReader file(table, 1, "", first_error);
  RobotModel robot;
  Chain& chain = robot.chain;
  chain.name = file.text_or("name", std::filesystem::path(name).stem().string());
  const Scales scales = read_scales(file, first_error);
  const Convention convention = read_convention(file, std::nullopt);
  chain.base = read_frame(file, "base", scales, first_error);
  chain.tool = read_frame(file, "tool", scales, first_error);
  chain.gravity = file.vector_or("gravity", chain.gravity);
  chain.joints = read_joints(file, convention, scales, first_error);
  chain.closures = read_closures(file, chain.joints, scales, first_error);
  chain.tip = file.has("tip") ? read_joint_reference(file, "tip", chain.joints) : (file.ignore("tip"), -1);
  chain.targets = read_targets(file, scales, first_error);
  chain.masses = read_masses(file, static_cast<int>(chain.joints.size()), scales, first_error);
  robot.tolerances = read_tolerances(file, scales, first_error);
  robot.instrument = read_instrument(file, scales, robot.instrument_position, first_error);
  chain.fixtures = read_fixtures(file, scales, first_error);
  read_socket_distances(file, chain.fixtures, scales, first_error);
  chain.mountings = read_mountings(file, chain.joints, scales, first_error);
  chain.setup = file.text_or("setup", "");
  chain.expansion = file.number_or("expansion", 0.0);
  chain.reference_temperature = file.number_or("reference_temperature", 0.0);
  file.ignore("expansion_sd");
  chain.field = read_displacement_field(file, dof(chain), first_error);
  robot.prediction = read_prediction(file, dof(chain), first_error);
  file.expect_no_other_keys();
  if (first_error.any()) return forward_error(first_error.as_error());
  if (const auto what = impossible_model(chain)) return error("{}: {}", name, *what);
  return robot;
}

Result<RobotModel> read_robot_toml(const std::filesystem::path& path) {
  KINFER_TRY(text, read_text_file(path));
  return parse_robot_toml(text, path.string());
}

}  // namespace kinfer
