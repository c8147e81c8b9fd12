// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/drawing_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "kinfer/io/evidence/json_parts.hpp"
#include "kinfer/kinematics/elementary_motions.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
namespace {

using Json = nlohmann::ordered_json;
using kinfer::json_of;  // in addition to the overloads below

/// Rounded to seven decimals; null where not finite.
Json round_number(double value) {
  constexpr double step = 1e-7;
  if (!std::isfinite(value)) return nullptr;
  const double rounded = std::round(value / step);
  return rounded == 0.0 ? 0.0 : rounded / 1e7;
}

/// Rounded to a power of ten below 1/4000 of the largest value: a plot on a screen resolves no more.
template <class List>
Json round_for_plot(const List& values) {
  double largest = 0.0;
  for (const double value : values)
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  const double per_unit = largest > 0.0 ? std::pow(10.0, std::ceil(std::log10(4000.0 / largest))) : 1.0;
  Json list = Json::array();
  for (const double value : values) {
    const double rounded = std::round(value * per_unit);
    list.push_back(!std::isfinite(value) ? Json(nullptr) : rounded == 0.0 ? Json(0) : Json(rounded / per_unit));
  }
  return list;
}

template <class List>
Json round_numbers(const List& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(round_number(value));
  return list;
}

Json json_of(const Pose& pose) {
  const Quat q(pose.rotation);
  return {{"xyz", json_of(pose.position)}, {"quat", {q.w(), q.x(), q.y(), q.z()}}};
}

/// A joint's transform, split at its motion.
struct SplitJoint {
  Pose before, after;
  Vec3 axis = Vec3::Zero();  ///< unit; zero: does not move
  bool is_split = false;

  void operator()(const elementary::Factor& factor) {
    elementary::apply(is_split ? after : before, factor.motion, factor.axis, factor.value);
    if (!factor.moves) return;
    axis = Vec3::Unit(factor.axis);
    is_split = true;
  }
  void operator()(const Mat3& rotation) {
    Pose& pose = is_split ? after : before;
    pose.rotation = pose.rotation * rotation;
  }
};

Json joint_json(const Joint& joint, const std::vector<int>& variable_indices, int variable_index) {
  SplitJoint parts;
  elementary::for_each_factor(joint, [&](const auto& step) { parts(step); });
  Json couplings = Json::array();
  for (const Coupling& c : joint.couplings) couplings.push_back({variable_indices[c.joint], c.factor});
  Json json{{"name", joint.name},
            {"parent", joint.parent},
            {"type", traits(joint.type).name},
            {"reading", variable_index},
            {"before", json_of(parts.before)},
            {"axis", json_of(parts.axis)},
            {"after", json_of(parts.after)},
            {"gain", joint.gain},
            {"couplings", couplings}};
  if (std::isfinite(joint.lower) && std::isfinite(joint.upper)) json["limits"] = {joint.lower, joint.upper};
  return json;
}

Json optional_json(const std::optional<Vec3>& v) {
  return v ? round_numbers(*v) : Json(nullptr);
}

Json json_of(const Envelope& e) {
  return {{"low", round_for_plot(e.low)}, {"high", round_for_plot(e.high)}};
}

Json json_of(const std::array<Envelope, 3>& axes) {
  return {json_of(axes[0]), json_of(axes[1]), json_of(axes[2])};
}

Json columns_json(const MatrixXd& matrix) {
  Json list = Json::array();
  for (Eigen::Index k = 0; k < matrix.cols(); ++k) list.push_back(round_numbers(matrix.col(k)));
  return list;
}

Json trace_json(const Trace& trace) {
  return {{"sensor", trace.sensor},
          {"quantity", name(trace.quantity)},
          {"unit", unit(trace.quantity)},
          {"frame", name(trace.frame)},
          {"rms_measured", trace.rms_measured},
          {"rms_fitted", trace.rms_fitted},
          {"rms_holdout", trace.rms_holdout},
          {"measured", json_of(trace.measured)},
          {"predicted", json_of(trace.predicted)},
          {"residual", json_of(trace.residual)}};
}

}  // namespace

nlohmann::ordered_json chain_json(const Chain& chain) {
  const std::vector<int> variable_indices = active_joint_indices(chain);
  Json joints = Json::array(), targets = Json::array();
  for (std::size_t i = 0; i < chain.joints.size(); ++i)
    joints.push_back(joint_json(chain.joints[i], variable_indices, variable_indices[i]));
  for (const Target& target : chain.targets) targets.push_back({{"name", target.name}, {"xyz", json_of(target.xyz)}});
  return {{"name", chain.name},
          {"base", json_of(chain.base.pose())},
          {"joints", joints},
          {"tip", chain.tip_joint()},
          {"tool", json_of(chain.tool.pose())},
          {"targets", targets},
          {"readings", active_joint_names(chain)}};
}

nlohmann::ordered_json picture_json(const CalibrationPlotData& plot_data, const Chain& calibrated) {
  Json measured = Json::array(), before = Json::array(), after = Json::array(), tools = Json::array();
  std::vector<double> predicted, uncertain;
  for (const PlotRow& row : plot_data.rows) {
    measured.push_back(optional_json(row.measured));
    before.push_back(optional_json(row.error_before));
    after.push_back(optional_json(row.error_after));
    predicted.push_back(row.predicted);
  }
  for (const WorkspacePoint& point : plot_data.workspace) {
    tools.push_back(round_numbers(point.tool));
    uncertain.push_back(point.predicted);
  }
  return {{"chains",
           {{"nominal", chain_json(plot_data.nominal)},
            {"before", chain_json(plot_data.before)},
            {"calibrated", chain_json(calibrated)}}},
          {"q", columns_json(plot_data.joints)},
          {"measured", measured},
          {"off_before", before},
          {"off_after", after},
          {"predicted", round_for_plot(predicted)},
          {"workspace", {{"tool", tools}, {"predicted", round_for_plot(uncertain)}}}};
}

nlohmann::ordered_json motion_json(const MotionEvidence& motion) {
  Json traces = Json::array(), windows = Json::array(), root = Json::array();
  for (const Trace& trace : motion.traces) traces.push_back(trace_json(trace));
  for (const TimeWindow& window : motion.held_out) windows.push_back({window.begin, window.end});
  for (const auto& quaternion : motion.trajectory.root) root.push_back(round_numbers(quaternion));
  return {
      {"time", round_numbers(motion.time)},
      {"held_out", windows},
      {"traces", traces},
      {"playback",
       {{"time", round_numbers(motion.trajectory.time)}, {"root", root}, {"q", columns_json(motion.trajectory.q)}}}};
}

nlohmann::ordered_json advice_json(const std::vector<Advice>& list) {
  Json json = Json::array();
  for (const Advice& advice : list) json.push_back({{"what", advice.what}, {"why", advice.why}});
  return json;
}

}  // namespace kinfer
