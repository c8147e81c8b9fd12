// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/files/calibration_files.hpp"

#include <fmt/format.h>

#include "kinfer/io/evidence/files/joint_tables_csv.hpp"
#include "kinfer/io/robot/urdf/urdf.hpp"
#include "kinfer/io/text/format_number.hpp"
#include "kinfer/kinematics/dh_conversion.hpp"

namespace kinfer {
namespace {

std::string accuracy_csv(const std::vector<PoseAccuracy>& poses) {
  std::string text = "row,rows,AP_before[mm],AP_after[mm],RP[mm]\n";
  for (const PoseAccuracy& p : poses)
    text += fmt::format("{},{},{},{},{}\n", p.rows.front(), p.rows.size(), format_number(p.accuracy_before, 1e-3),
                        format_number(p.accuracy_after, 1e-3),
                        p.repeatability ? format_number(*p.repeatability, 1e-3) : "");
  return text;
}

std::string chain_toml(const Calibration& calibration, RobotModel robot) {
  StandardDeviations sd;
  for (const ParameterEstimate& p : calibration.estimate.values) sd[p.name] = p.sd;
  robot.chain = corrected_chain(calibration);
  robot.tolerances = calibration.nominal_model.tolerances;
  robot.prediction = calibration.prediction;
  return format_robot_toml(robot, sd);
}

}  // namespace

std::vector<OutputFile> calibration_files(const Calibration& calibration, RobotModel robot) {
  const Estimate& estimate = calibration.estimate;
  std::vector<OutputFile> files{
      {"chain.toml", chain_toml(calibration, std::move(robot))},
      {"chain.urdf", format_urdf(corrected_chain(calibration))},
      {"joint_twists.csv", format_joint_twists_csv(estimate.chain)},
      {"encoder_offsets.csv", format_encoder_offsets_csv(calibration.nominal_model.chain, estimate)},
      {"covariance.csv", format_covariance_csv(estimate)}};
  if (!estimate.search.net.empty()) files.push_back({"net.txt", estimate.search.net});
  if (const auto mdh = as_mdh(estimate.chain)) files.push_back({"chain_mdh.csv", format_dh_table_csv(*mdh)});
  if (const auto dh = as_dh(estimate.chain)) files.push_back({"chain_dh.csv", format_dh_table_csv(*dh)});
  if (!calibration.accuracy.empty()) files.push_back({"accuracy.csv", accuracy_csv(calibration.accuracy)});
  return files;
}

}  // namespace kinfer
