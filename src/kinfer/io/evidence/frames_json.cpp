// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/frames_json.hpp"

#include <nlohmann/json.hpp>

#include "kinfer/geometry/rotation.hpp"
#include "kinfer/io/evidence/json_parts.hpp"
#include "kinfer/words/calibration_frames.hpp"

namespace kinfer {
namespace {

using Json = nlohmann::ordered_json;
using kinfer::json_of;  // in addition to the overloads below

Json json_of(const SweepCircle& c) {
  return {{"name", words::sweep_name(c)},
          {"joint", c.joint},
          {"rows", c.rows},
          {"swept_rad", c.swept},
          {"centre", json_of(c.centre)},
          {"axis", json_of(c.axis)},
          {"radius", c.radius},
          {"rms", c.rms},
          {"sd",
           {{"centre_m", finite_json(c.centre_sd)},
            {"axis_rad", finite_json(c.axis_sd)},
            {"radius_m", finite_json(c.radius_sd)}}},
          {"off_by", c.off_by},
          {"turned_by", c.axis_angle}};
}

Json json_of(const Frame& frame) {
  const Pose pose = frame.pose();
  return {{"xyz", json_of(pose.position)}, {"rpy", json_of(to_rpy(pose.rotation))}};
}

}  // namespace

std::string format_frames_evidence(const FrameEstimate& found) {
  Json sweeps = Json::array();
  for (const SweepCircle& circle : found.sweeps) sweeps.push_back(json_of(circle));
  const Json json{{"format", "kinfer-evidence/1"},
                  {"kind", "frames"},
                  {"base", json_of(found.chain.base)},
                  {"base_from", words::base_source(found)},
                  {"tool", json_of(found.chain.tool)},
                  {"papers_tool_length",
                   {{"from", words::tool_length_source(found)},
                    {"source", name(found.tool_length_source)},
                    {"value", found.tool_length}}},
                  {"closed_form_start",
                   {{"base_differs_m", found.base_differs},
                    {"base_turned_rad", found.base_turned},
                    {"tool_differs_m", found.tool_differs}}},
                  {"sweeps", sweeps}};
  return json.dump(1) + "\n";
}

}  // namespace kinfer
