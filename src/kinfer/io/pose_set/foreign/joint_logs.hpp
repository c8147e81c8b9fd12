// SPDX-License-Identifier: Apache-2.0
// Joint positions as controllers and simulators log them: UR RTDE, KUKA RSI, OpenSim storage.
#pragma once

#include "kinfer/io/pose_set/foreign/pose_table.hpp"

namespace kinfer {

/// `timestamp actual_q_0 …`: rad, s; delimiter a blank or a comma.
bool is_ur_rtde(std::string_view head);
Result<PoseTable> read_ur_rtde(std::string_view text, const std::string& name, const PoseTableChoice* choice);

/// Telegrams <Rob> … <AIPos A1= …/> … <IPOC>…</IPOC> … </Rob>, whatever stands between them: deg, ms. Or a table with
/// columns that end in AIPos.A1 ….
bool is_kuka_rsi(std::string_view head);
Result<PoseTable> read_kuka_rsi(std::string_view text, const std::string& name, const PoseTableChoice* choice);

/// .sto and .mot: coordinates of a model's joints, in degrees or radians as `inDegrees` says; m where a joint slides.
bool is_opensim_storage(std::string_view head);
Result<PoseTable> read_opensim_storage(std::string_view text, const std::string& name, const PoseTableChoice* choice);

}  // namespace kinfer
