// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/tracking/tracked_chain.hpp"

#include <algorithm>
#include <filesystem>

#include "kinfer/io/recording/machine_facts_toml.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"
#include "kinfer/io/tracking/tracking_model_toml.hpp"

namespace kinfer {
namespace {

/// The tool of chain.toml, which its user may have changed since.
void take_tool(TrackingModel& model, const Chain& chain) {
  const std::string& tip = chain.joints[static_cast<std::size_t>(chain.tip_joint())].name;
  const auto carrier = std::ranges::find(model.sensors, tip, &TrackingSensor::name);
  if (carrier == model.sensors.end()) return;
  const Pose tool = chain.tool.pose();
  const bool is_same =
      model.tool.body == carrier->body && (model.tool.body_T_tool.position - tool.position).norm() < 1e-9;
  model.tool = {carrier->body, tool, is_same ? model.tool.sd : Vec3::Zero()};
}

Result<void> take_tool(TrackingModel& model, const std::string& file) {
  KINFER_TRY(facts, read_machine_facts(file));
  const auto is_tool = [&](const SegmentPoint& place) {
    return place.name == "tip" || place.name == "tool" || facts.places.size() == 1;
  };
  const auto place = std::ranges::find_if(facts.places, is_tool);
  if (place == facts.places.end()) return error("{}: no place named tip or tool", file);
  if (!place->xyz)
    return error("{}: the place {} has no xyz: kinfer identify --facts finds it and keeps it in the chain", file,
                 place->name);
  const auto carrier = std::ranges::find(model.sensors, place->sensor, &TrackingSensor::name);
  if (carrier == model.sensors.end()) return error("{}: the chain has no sensor {}", file, place->sensor);
  model.tool = {carrier->body, {Mat3::Identity(), *place->xyz}, Vec3::Constant(place->sigma)};
  return {};
}

}  // namespace

ChainFiles::ChainFiles(const std::string& path) {
  const std::filesystem::path given(path);
  const bool is_file = given.filename() == "chain.toml" || given.filename() == "track.toml";
  const std::filesystem::path folder = is_file ? given.parent_path() : given;
  chain = folder / "chain.toml";
  tracking = folder / "track.toml";
}

Result<TrackedChain> read_tracked_chain(const std::string& chain, const std::string& facts) {
  const ChainFiles files(chain);
  if (!std::filesystem::exists(files.chain))
    return error("{}: expected a folder that kinfer identify wrote, with chain.toml and track.toml", chain);
  KINFER_TRY(robot, read_robot_toml(files.chain));
  if (!std::filesystem::exists(files.tracking))
    return error(
        "{}: the chain has no tracking data, track.toml: it is of --geometry searched, or of a recording that was not "
        "informative enough for the fit; identify the machine again, without that option or from another recording",
        chain);
  KINFER_TRY(model, read_tracking_model(files.tracking));
  if (position_names(model) != active_joint_names(robot.chain))
    return error("{}: chain.toml and track.toml are of different machines: their joints differ", chain);
  take_tool(model, robot.chain);
  if (!facts.empty())
    if (auto done = take_tool(model, facts); !done) return forward_error(done.error());
  return TrackedChain{std::move(robot.chain), std::move(model)};
}

}  // namespace kinfer
