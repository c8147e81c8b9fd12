// SPDX-License-Identifier: Apache-2.0
// A machine that was identified before, as the structure of its next identification: sensors, order and joint types
// are not searched again.
#pragma once

#include "kinfer/identify/handover/known_joint.hpp"
#include "kinfer/identify/joints/joint_result.hpp"
#include "kinfer/identify/refinement/joints/refined_joint.hpp"
#include "kinfer/identify/structure/given_tree.hpp"
#include "kinfer/identify/structure/joint_type.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer::identify {

std::vector<std::string> sensor_names(const TrackingModel& known);
std::string root_sensor(const TrackingModel& known);
std::vector<GivenLink> links_of(const TrackingModel& known);

/// An error if the log lacks a sensor of the machine.
Result<void> check_sensors(const TrackingModel& known, const InsRecording& log);

/// An error if a sensor of the machine was left out of what is identified. `segments`: their names.
Result<void> check_segments(const TrackingModel& known, const std::vector<std::string>& segments);

/// The same machine with its joints in the order of a segment tree with the same links. `segments`: names of the tree's
/// segments.
TrackingModel in_order_of(const SegmentTree& tree, const std::vector<std::string>& segments,
                          const TrackingModel& known);

/// A joint as evidence, with the standard deviations of the model's covariance, at the model's zero.
RefinedJoint as_refined(const KnownJoint& joint, const TrackingModel& model);

/// The joints as a search would have found them, in the model's order.
std::vector<JointResult> known_results(const TrackingModel& known);

}  // namespace kinfer::identify
