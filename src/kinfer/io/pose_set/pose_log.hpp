// SPDX-License-Identifier: Apache-2.0
// A file of joint positions or measured points, in whatever form: kinfer's CSV, a file of another program, a robot log.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/io/pose_set/column_map.hpp"
#include "kinfer/io/pose_set/required_content.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// What the user says about a file.
struct PoseLogChoice {
  ColumnMap map{};                    ///< without columns: recognised formats are read as they are known
  std::string marker{};               ///< of a tracker's file
  std::vector<std::string> topics{};  ///< of a robot log; empty: the only one that fits
};

struct PoseLog {
  PoseSet set{};
  std::string format{};                ///< "Qualisys tsv"; empty: kinfer's columns
  std::vector<std::string> remarks{};  ///< for the user, one sentence each
};

/// `required`: joints_only or targets.
Result<PoseLog> read_pose_log(const std::filesystem::path& path, const Chain& chain, const PoseLogChoice& choice,
                              RequiredContent required);

}  // namespace kinfer
