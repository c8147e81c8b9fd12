// SPDX-License-Identifier: Apache-2.0
// Simulated machines, driven and measured, with their ground truth.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "kinfer/identify/pipeline.hpp"
#include "kinfer/measurement/ins/ins_selection.hpp"
#include "kinfer/simulate/ground_truth.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "kinfer/words/findings/findings.hpp"
#include "simulate/worlds.hpp"

namespace kinfer::test {
using namespace identify;

struct DrivenMachine {
  InsRecording recording;
  MachineTruth truth;
};

inline DrivenMachine driven_machine(const std::string& name, std::uint64_t seed, Script script = Script::standard,
                                    const MachineOptions& options = {.mounting = Mounting::arbitrary},
                                    const char* grade = "industrial") {
  const MujocoWorld world = world_of(name, options, seed);
  const MachineMotion motion = world.prescribe(drive_of(world.machine(), {.script = script}, seed), 100.0);
  return {simulate_recording(world.machine(), motion, *sensor_grade(grade), {}, Rng(seed)),
          machine_truth(world.machine(), motion)};
}

/// What the first sensors measure, the others not mounted.
inline DrivenMachine first_sensors(DrivenMachine machine, std::size_t count) {
  std::vector<std::size_t> kept(count);
  std::iota(kept.begin(), kept.end(), 0U);
  machine.recording = select_sensors(machine.recording, kept);
  std::erase_if(machine.truth.joints, [&](const JointTruth& joint) {
    return std::ranges::none_of(machine.recording.sensors,
                                [&](const InsSensor& sensor) { return sensor.name == joint.child; });
  });
  return machine;
}

/// The base and the first joints of a general excavator: for what does not depend on how many joints there are, in a
/// fraction of the time.
inline DrivenMachine driven_arm(std::uint64_t seed, std::size_t sensors, Script script = Script::together,
                                const MachineOptions& options = {.mounting = Mounting::arbitrary}) {
  return first_sensors(driven_machine("excavator-general", seed, script, options), sensors);
}

/// Distance of an estimated axis line from the true one in the child's sensor, without unobservable directions [m].
inline double line_error(const JointEstimate& found, const JointTruth& truth) {
  Vec3 error = found.point_in_child - truth.point_in_child;
  std::vector<Vec3> free{truth.axis_in_child};
  for (const Vec3& hidden : truth.unobservable_in_child)
    if (hidden.cross(free.front()).norm() > 1e-3)
      free.push_back((hidden - free.front() * free.front().dot(hidden)).normalized());
  for (const Vec3& direction : free) error -= direction * direction.dot(error);
  return error.norm();
}

/// Worst over the estimated joints; a true joint that is not among them counts as 1 m.
inline double worst_line_error(const std::vector<JointEstimate>& found, const MachineTruth& truth) {
  double worst = 0.0;
  for (const JointTruth& joint : truth.joints) {
    const auto f = std::ranges::find_if(
        found, [&](const JointEstimate& j) { return j.parent == joint.parent && j.child == joint.child; });
    if (f == found.end()) return 1.0;
    if (joint.type == JointType::revolute) worst = std::max(worst, line_error(*f, joint));
  }
  return worst;
}

inline Identification identified(const InsRecording& recording, const IdentifyOptions& options = {}) {
  const auto found = identify_machine(recording, options, Rng(1));
  EXPECT_TRUE(found) << found.error().what;
  return found ? *found : Identification{};
}

inline bool has_finding(const Identification& found, const std::string& kind, const std::string& word = "") {
  return std::ranges::any_of(found.findings, [&](const Finding& f) {
    return name(f.kind) == kind && words::sentence(f).find(word) != std::string::npos;
  });
}

}  // namespace kinfer::test
