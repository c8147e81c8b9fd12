// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/deployment/frame_estimate.hpp"

namespace kinfer {

std::string_view name(ToolLengthSource source) {
  switch (source) {
    case ToolLengthSource::mean_tool_point:
      return "mean_tool_point";
    case ToolLengthSource::sweep_radius:
      return "sweep_radius";
    case ToolLengthSource::radius_without_fit:
      return "radius_without_fit";
  }
  return "";
}

}  // namespace kinfer
