// SPDX-License-Identifier: Apache-2.0
// The user's own robot file with calibrated origins: written, and the table of what was changed.
#pragma once

#include <optional>
#include <string>

#include "kinfer/cli/parts/output_folder.hpp"
#include "kinfer/io/evidence/files/model_patch_files.hpp"

namespace kinfer::cli {

/// Refuses --offsets where no robot file can be written back.
Result<void> check_offsets(bool given, const RobotModel& robot);

/// None where the file has a format that is not written back. A file that cannot be changed in place is no reason to
/// lose the calibration: what is wrong is printed.
std::optional<ModelPatch> write_model_patch(OutputFolder& folder, const RobotModel& robot,
                                            const Calibration& calibration, EncoderOffsets offsets);

std::string model_patch_summary(const ModelPatch& patch);

}  // namespace kinfer::cli
