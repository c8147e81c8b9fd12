// SPDX-License-Identifier: Apache-2.0
// Tables that calibrate writes beside chain.toml: other conventions, encoder offsets, covariance, ISO 9283.
#pragma once

#include <filesystem>

#include "kinfer/calibrate/calibrate.hpp"

namespace kinfer::cli {

/// chain_mdh.csv, chain_dh.csv, joint_twists.csv, encoder_offsets.csv, covariance.csv, accuracy.csv. DH and MDH are
/// omitted if joints are coupled or the chain branches.
Result<void> write_calibration_tables(const std::filesystem::path& folder, const calibrate::CalibrationTask& task,
                                      const Calibration& calibration);

/// Pose accuracy and, for repeated poses, repeatability in one sentence; empty if no tool point was measured.
std::string pose_accuracy_sentence(const Calibration& calibration);

}  // namespace kinfer::cli
