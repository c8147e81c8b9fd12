// SPDX-License-Identifier: Apache-2.0
// Targets of `kinfer reach` as CSV, and the postures that reach them (docs/formats.md, `reach`).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/motion/reach_solution.hpp"
#include "kinfer/io/pose_set/column_map.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/kinematics/reach_target.hpp"

namespace kinfer {

struct ReachTargets {
  std::vector<ReachTarget> targets;
  MatrixXd preferred;  ///< dof x targets, [rad] or [m]; empty where the file has no joint columns
};

/// x, y, z of every target; qw, qx, qy, qz, or axis_i, axis_j, axis_k (unit vector along the tool axis), or pitch where
/// orientations are wanted; q1.. for preferred postures. A row without an orientation leaves it free.
Result<ReachTargets> read_reach_targets(const std::filesystem::path& path, const Chain& chain, const ColumnMap& map);
Result<ReachTargets> parse_reach_targets(std::string_view text, const std::string& name, const Chain& chain,
                                         const ColumnMap& map);

/// Header of a joint column of a result, and its unit in SI.
struct JointColumn {
  std::string header;
  double factor = 1.0;
};

/// target, posture, status, the joint columns, position_error[mm], angle_error[deg]; one row per posture. A target that
/// is not reached has the closest posture inside the limits, and its status.
std::string format_postures_csv(const std::vector<ReachSolution>& solutions, const std::vector<JointColumn>& columns);

}  // namespace kinfer
