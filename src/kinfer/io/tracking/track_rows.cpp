// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/tracking/track_rows.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "kinfer/base/angle.hpp"
#include "kinfer/io/text/csv_text.hpp"
#include "kinfer/io/text/dump_json.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

/// Nine digits: a millionth of a degree in a thousand degrees.
void append_number(std::string& out, double value) {
  if (std::isfinite(value)) fmt::format_to(std::back_inserter(out), "{:.9g}", value);
}

void append_cell(std::string& out, double value) {
  out += ',';
  append_number(out, value);
}

void append_json_number(std::string& out, double value) {
  if (std::isfinite(value))
    append_number(out, value);
  else
    out += "null";
}

template <class Values>
void append_json_list(std::string& out, const char* key, const Values& values) {
  fmt::format_to(std::back_inserter(out), ",\"{}\":[", key);
  for (Index i = 0; i < values.size(); ++i) {
    if (i > 0) out += ',';
    append_json_number(out, values[i]);
  }
  out += ']';
}

Eigen::Vector4d coefficients(const Quat& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

/// The same rotation with w ≥ 0.
Eigen::Vector4d upper_half(const Quat& q) {
  return q.w() < 0.0 ? Eigen::Vector4d(-coefficients(q)) : coefficients(q);
}

}  // namespace

TrackRowWriter::TrackRowWriter(const TrackingModel& model, std::optional<BasePlace> place)
    : positions_(position_names(model)), place_(std::move(place)) {
  for (const TrackingJoint& joint : model.joints) {
    joints_.push_back(joint.name);
    unit_.insert(unit_.end(), static_cast<std::size_t>(joint.positions),
                 joint.type == EstimatedJointType::prismatic ? 1e-3 : degree);
  }
  for (const TrackingSensor& sensor : model.sensors) sensors_.push_back(sensor.name);
}

std::string TrackRowWriter::header() const {
  std::string text = "t[s]";
  for (const auto& [name, per] : {std::pair{"q", ""}, std::pair{"qd", "/s"}, std::pair{"sd_q", ""}})
    for (std::size_t k = 0; k < positions_.size(); ++k)
      text += "," + csv_cell(fmt::format("{}_{}[{}{}]", name, positions_[k], unit_[k] == 1e-3 ? "mm" : "deg", per));
  text +=
      ",tool_x[mm],tool_y[mm],tool_z[mm],tool_qw,tool_qx,tool_qy,tool_qz,sd_tool_x[mm],sd_tool_y[mm],sd_tool_z[mm],"
      "sd_tool_rx[deg],sd_tool_ry[deg],sd_tool_rz[deg],base_qw,base_qx,base_qy,base_qz,sd_base_rx[deg],"
      "sd_base_ry[deg],sd_base_rz[deg]";
  if (place_)
    text +=
        ",world_tool_x[mm],world_tool_y[mm],world_tool_z[mm],world_tool_qw,world_tool_qx,world_tool_qy,world_tool_qz";
  return text + ",alarm\n";
}

Pose TrackRowWriter::tool_in_world(const TrackState& state) {
  const Mat3 level_R_base = state.world_q_base.toRotationMatrix();
  if (!first_heading_) first_heading_ = std::atan2(level_R_base(1, 0), level_R_base(0, 0));
  return Pose{rot_z(place_->heading - *first_heading_) * level_R_base, place_->position} * state.base_T_tool;
}

void TrackRowWriter::append_csv(const TrackState& state, std::string& out) {
  fmt::format_to(std::back_inserter(out), "{}", state.time);
  for (const VectorXd* values : {&state.q, &state.qd, &state.sd_q})
    for (Index k = 0; k < values->size(); ++k) append_cell(out, (*values)[k] / unit_[static_cast<std::size_t>(k)]);
  const bool has_tool = state.q.allFinite();
  const auto append_all = [&](const auto& values, double unit, bool is_known) {
    for (Index i = 0; i < values.size(); ++i) append_cell(out, is_known ? values[i] / unit : std::nan(""));
  };
  append_all(state.base_T_tool.position, 1e-3, has_tool);
  append_all(upper_half(Quat(state.base_T_tool.rotation)), 1.0, has_tool);
  append_all(state.sd_tool_position, 1e-3, has_tool);
  append_all(state.sd_tool_rotation, degree, has_tool);
  append_all(upper_half(state.world_q_base), 1.0, state.started);
  append_all(state.sd_base, degree, state.started);
  if (place_) {
    const bool is_known = has_tool && state.started;
    const Pose tool = is_known ? tool_in_world(state) : Pose{};
    append_all(tool.position, 1e-3, is_known);
    append_all(upper_half(Quat(tool.rotation)), 1.0, is_known);
  }
  out += ',' + csv_cell(alarm_cell(state)) + '\n';
}

std::string TrackRowWriter::alarm_cell(const TrackState& state) const {
  std::string cell;
  for (const TrackAlarm& alarm : state.alarms) {
    if (!cell.empty()) cell += ' ';
    cell += name(alarm.kind);
    if (alarm.sensor >= 0) cell += ':' + sensors_[static_cast<std::size_t>(alarm.sensor)];
    if (alarm.joint >= 0) cell += ':' + joints_[static_cast<std::size_t>(alarm.joint)];
  }
  return cell;
}

void TrackRowWriter::append_json(const TrackState& state, std::string& out) {
  const bool has_tool = state.q.allFinite();
  fmt::format_to(std::back_inserter(out), "{{\"t\":{}", state.time);
  append_json_list(out, "q", state.q);
  append_json_list(out, "qd", state.qd);
  append_json_list(out, "sd_q", state.sd_q);
  if (has_tool) {
    append_json_list(out, "tool_xyz", state.base_T_tool.position);
    append_json_list(out, "tool_quat", upper_half(Quat(state.base_T_tool.rotation)));
    append_json_list(out, "sd_tool_xyz", state.sd_tool_position);
    append_json_list(out, "sd_tool_rotation", state.sd_tool_rotation);
    if (place_) {
      const Pose tool = tool_in_world(state);
      append_json_list(out, "world_tool_xyz", tool.position);
      append_json_list(out, "world_tool_quat", upper_half(Quat(tool.rotation)));
    }
  }
  append_json_list(out, "base_quat", upper_half(state.world_q_base));
  append_json_list(out, "sd_base", state.sd_base);
  out += ",\"alarm\":" + dump_json(nlohmann::ordered_json(alarm_cell(state))) + "}\n";
}

}  // namespace kinfer
