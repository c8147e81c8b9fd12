// SPDX-License-Identifier: Apache-2.0
// Robot models as TOML (docs/formats.md): nominal models in, chain.toml out.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/calibration/model_patch.hpp"
#include "kinfer/evidence/calibration/prediction_model.hpp"
#include "kinfer/io/robot/model/chain_ends.hpp"
#include "kinfer/io/text/units.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// The text of a robot file that can be written back with other numbers: URDF or MJCF.
struct RobotSource {
  RobotFileFormat format = RobotFileFormat::urdf;
  std::string name;  ///< of the file, without its folder
  std::string text;  ///< its bytes
  ChainEnds ends;    ///< as they were chosen
};

/// The contents of a robot file.
struct RobotModel {
  Chain chain{};
  Tolerances tolerances{};
  std::optional<Instrument> instrument{};       ///< absent: estimated from the residuals
  std::optional<Vec3> instrument_position{};    ///< [m] position of the instrument in the world; for planning
  std::optional<PredictionModel> prediction{};  ///< uncertainty of a calibrated chain
  std::optional<RobotSource> source{};          ///< where the format is the user's own, not ours
};

/// Reads a robot file. Unknown keys, missing fields, wrong types, zero joints and broken trees are errors with the
/// line.
Result<RobotModel> read_robot_toml(const std::filesystem::path& path);
Result<RobotModel> parse_robot_toml(std::string_view text, const std::string& name_in_messages);

/// Standard deviations by parameter name, SI; those that are absent are not written.
using StandardDeviations = std::map<std::string, double>;

/// chain.toml: the same form, in the given units, with `a_sd = …` beside each number that has a standard deviation.
/// Written with full precision, so that reading it back gives the same poses.
std::string format_robot_toml(const RobotModel& robot, const StandardDeviations& sd = {},
                              FileUnits units = FileUnits::mm_deg);

}  // namespace kinfer
