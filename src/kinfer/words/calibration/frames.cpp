// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/calibration/frames.hpp"

#include "kinfer/words/language.hpp"

namespace kinfer::words {

std::string sweep_name(const SweepCircle& circle) {
  return circle.name.empty() ? fmt::format("rows {} to {}", circle.first_row, circle.last_row) : circle.name;
}

std::string base_source(const FrameEstimate& frames) {
  return fmt::format("joint {} and joint {}", frames.base_joints[0], frames.base_joints[1]);
}

std::string tool_length_source(const FrameEstimate& frames) {
  const std::string_view id = name(frames.tool_length_source);
  switch (frames.tool_length_source) {
    case ToolLengthSource::mean_tool_point:
      return phrase(id, "no sweep of the last joint but one");
    case ToolLengthSource::sweep_radius:
      return phrase(id, "radius of the sweep of joint {}", frames.tool_joint);
    case ToolLengthSource::radius_without_fit:
      return phrase(id, "radius of the sweep of joint {} does not fit a tool on the flange's axis", frames.tool_joint);
  }
  return "";
}

}  // namespace kinfer::words
