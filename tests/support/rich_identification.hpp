// SPDX-License-Identifier: Apache-2.0
// An identification, and frames, with every member set, invented: what evidence.json and its report must carry.
#pragma once

#include "support/rich_parts.hpp"

namespace kinfer::test {

/// One sensor's signal of `bins` bins with a gap.
inline std::array<Envelope, 3> rich_signal(std::size_t bins, double size) {
  Envelope envelope;
  for (std::size_t i = 0; i < bins; ++i) {
    const double value = size * std::sin(0.3 * static_cast<double>(i));
    envelope.low.push_back(i == 3 ? not_measured : value);
    envelope.high.push_back(i == 3 ? not_measured : value + 0.1 * size);
  }
  Envelope still{std::vector<double>(bins, 0.0), std::vector<double>(bins, 0.0)};
  return {envelope, still, still};
}

inline MotionEvidence rich_motion(std::size_t bins) {
  MotionEvidence motion;
  for (std::size_t i = 0; i < bins; ++i) motion.time.push_back(0.1 * static_cast<double>(i));
  motion.traces = {{.sensor = "s<1>",
                    .quantity = TraceQuantity::acceleration,
                    .frame = TraceFrame::world,
                    .measured = rich_signal(bins, 2.0),
                    .predicted = rich_signal(bins, 1.9),
                    .residual = rich_signal(bins, 0.1),
                    .rms_measured = 1.5,
                    .rms_fitted = 0.1,
                    .rms_holdout = 0.12},
                   {.sensor = "s<1>",
                    .quantity = TraceQuantity::angular_velocity,
                    .frame = TraceFrame::sensor,
                    .measured = rich_signal(bins, 0.2),
                    .predicted = rich_signal(bins, 0.2),
                    .residual = rich_signal(bins, 0.01)}};
  motion.held_out = {{0.2, 0.4}, {0.8, 0.9}};
  motion.trajectory.time = {0.0, 0.5, 1.0};
  motion.trajectory.root = {{1, 0, 0, 0}};
  motion.trajectory.q = MatrixXd::Constant(1, 3, 0.25);
  return motion;
}

inline std::vector<JointEstimate> rich_joints() {
  JointEstimate hinge{.parent = "s0", .child = "s<1>", .axis_in_parent = Vec3::UnitX()};
  hinge.point_in_parent = {0.1, 0.2, 0.3}, hinge.point_in_child = {-0.1, 0.0, 0.05};
  hinge.sd = {{1e-3, 2e-3}, {3e-3, 4e-3}, {1e-3, 2e-3}, {0.9, 0.001}, 0.004};
  hinge.unobservable = {{.kind = UnobservableKind::point_along, .sensor = "s<1>", .directions = {Vec3::UnitX()}},
                        {.kind = UnobservableKind::offset_split, .other_joint = "s<1>-s2"}};
  hinge.unobservable_in_child = {Vec3::UnitX()};
  JointEstimate ball{.parent = "s<1>", .child = "s2", .type = EstimatedJointType::spherical};
  ball.azimuth_unobservable = true;
  ball.type_probabilities = {{.of_type = {0.2, 0.0, 0.1, 0.7, 0.0}}};
  return {hinge, ball};
}

inline Identification rich_identification() {
  Identification found;
  found.root = "s0";
  found.joints = rich_joints();
  found.loops = {{.joint = {.parent = "s0", .child = "s2", .axis_in_parent = Vec3::UnitY()},
                  .segments = {"s0", "s<1>", "s2"},
                  .gap = 2e-3,
                  .misalignment = 1e-3,
                  .mirrored_gap = 0.2,
                  .log_odds = 40.5}};
  found.links = {{"s<1>", "s0-s<1>", "s<1>-s2", 0.35, 0.002}, {"s2", "a", "b", 0.1, 0.9}};
  found.places = {{"tip", "s2", Vec3(0.1, 0, 0.2), Vec3(1e-3, 1e-3, 2e-3)}};
  found.clocks = {{"s<1>", 0.0123, 1.7e-6, 1e-4, 3e-7}};
  found.forecast = {{.joint = "s0-s<1>",
                     .line_sd = 1.3e-3,
                     .direction_sd = 2e-3,
                     .azimuth_of = "s0",
                     .azimuth_sd = 4e-3,
                     .acceleration_factor = 2.0,
                     .time_factor = 4.0},
                    {.joint = "s<1>-s2", .line_sd = 1e-3, .direction_sd = 1e-3, .is_sufficient = true}};
  found.dh = {{"s<1>", {0.1, 0.2, 0.3, 0.4, 0.5}, {1e-3, 2e-3, 3e-3, 0.9, 0.0}, "s0-s<1>", "s<1>", ""},
              {"s2", {0.1, 0.2, 0.3, 0.4, 0.0}, {}, "", "", "s<1>-s2"}};
  found.searches = {{.segment = "s<1>",
                     .fitted = {1.5, 0.2, 0.01},
                     .holdout = {1.6, 0.3, 0.02},
                     .written_fitted = LinkFit{1.7, 0.25, 0.015},
                     .written_holdout = LinkFit{1.68, 0.31, 0.021},
                     .rows = 40,
                     .found = found.dh,
                     .merged = {found.dh.front()},
                     .evaluations = 5000000000,
                     .generations = 30,
                     .best = {3.0, 2.0, 1.5},
                     .median = {4.0, 3.0, 2.0}}};
  found.order = {.sensors = {"s0", "s<1>", "s2"},
                 .pairs = {{"s0", "s<1>", 0.05, 0.01, 1.2, true},
                           {"s<1>", "s2", 0.02, 0.01, 0.7, true},
                           {"s0", "s2", 0.9, 0.4, 3.0, false}},
                 .margin = 5.5,
                 .phases = {{0.0, 1.0, {true, false, true}}},
                 .rank = {0, 1, 2},
                 .phases_agree = true};
  found.chain.name = "found";
  found.chain.joints = {mdh_joint(0.3, 90.0, 0.1, -90, 90, -1)};
  found.chain.joints.front().name = "s<1>";
  found.search_method = LinkSearchMethod::enumeration;
  found.motion = rich_motion(12);
  found.findings = {rich_finding(FindingKind::idle, Severity::note, false)};
  found.advice = {
      {IdentificationAdviceKind::move_joint, {{"parent", std::string("s0")}, {"child", std::string("s<1>")}}}};
  found.notes = {
      {IdentificationNoteKind::universal_joint, {{"parent", std::string("s0")}, {"child", std::string("s<1>")}}}};
  found.prediction = {12.0, 0.05};
  found.usability = Usability::use_with_care;
  return found;
}

inline FrameEstimate rich_frames() {
  FrameEstimate found;
  found.chain = rich_chain();
  found.sweeps = {{.name = "sweep \"1\"",
                   .joint = "J1",
                   .rows = 12,
                   .swept = 1.2,
                   .radius = 0.8,
                   .rms = 1e-5,
                   .axis_sd = not_measured,
                   .centre_sd = 2e-5,
                   .radius_sd = 1e-5,
                   .off_by = 1e-4,
                   .axis_angle = 2e-4}};
  found.base_joints = {"J1", "J<2>"}, found.tool_length = 0.2, found.tool_joint = "J5";
  found.tool_length_source = ToolLengthSource::sweep_radius;
  found.base_differs = 1e-3, found.base_turned = 2e-3, found.tool_differs = 3e-3;
  return found;
}

}  // namespace kinfer::test
