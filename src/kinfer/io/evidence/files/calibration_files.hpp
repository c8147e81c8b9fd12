// SPDX-License-Identifier: Apache-2.0
// The files that a calibration writes beside evidence.json and the report.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/calibration/calibration.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"

namespace kinfer {

struct OutputFile {
  std::string name, text;
};

/// chain.toml, chain.urdf, net.txt (of BPNN-PSO), joint_twists.csv, encoder_offsets.csv, covariance.csv,
/// chain_mdh.csv, chain_dh.csv, accuracy.csv. DH and MDH are omitted if joints are coupled or the chain branches,
/// accuracy.csv where no tool point was measured. `robot`: the robot file, whose instrument is kept in chain.toml.
std::vector<OutputFile> calibration_files(const Calibration& calibration, RobotModel robot);

}  // namespace kinfer
