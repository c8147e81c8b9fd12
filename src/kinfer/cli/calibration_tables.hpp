// The tables that calibrate leaves beside chain.toml: other conventions, encoder offsets, covariance, ISO 9283.
#pragma once

#include <filesystem>

#include "kinfer/calibrate/calibrate.hpp"

namespace kinfer::cli {

/// chain_mdh.csv, chain_dh.csv, joint_twists.csv, encoder_offsets.csv, covariance.csv, accuracy.csv. DH and MDH are
/// left out where joints are coupled or branch.
Result<void> write_calibration_tables(const std::filesystem::path& folder, const CalibrateTask& task,
                                      const Calibration& calibration);

/// Pose accuracy and, where poses repeat, repeatability in one sentence; empty where no tool point was measured.
std::string accuracy_in_words(const Calibration& calibration);

}  // namespace kinfer::cli
