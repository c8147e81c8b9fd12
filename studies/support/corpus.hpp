// SPDX-License-Identifier: Apache-2.0
// Logs to judge verdicts by: sound ones of simulated machines, and nonsense made of simulated sensors.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/measurement/ins/ins_recording.hpp"
#include "kinfer/simulate/ground_truth.hpp"

namespace kinfer::study {

struct JudgedLog {
  std::string kind, name;  ///< "sound", "excavator noise standard 17"
  InsRecording recording;
  std::optional<MachineTruth> truth{};  ///< of sound logs
};

/// "unrelated": sensors that have nothing to do with each other, "shuffled": the second half of a sensor comes from
/// another log or another segment, "bodies": segments on a running body that share no joint, "twice": a sensor in the
/// log under two names, "wheels": sensors of unknown gain on the wheels of a car, "stick": a rigid stick waved by hand.
const std::vector<std::string>& nonsense_kinds();

/// Number `index` of the sound logs, cycling through machines, grades, drives and bases.
JudgedLog sound_log(std::uint64_t seed, std::size_t index);
JudgedLog nonsense_log(const std::string& kind, std::uint64_t seed, std::size_t index);

}  // namespace kinfer::study
