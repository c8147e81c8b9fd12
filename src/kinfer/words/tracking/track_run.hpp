// SPDX-License-Identifier: Apache-2.0
// Sentences about a run of a tracker.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/tracking/track_run.hpp"

namespace kinfer::words {

/// "ins3 does not agree with the chain: it was turned, shifted or put elsewhere"
std::string sentence(const TrackAlarm& alarm, const std::vector<std::string>& sensors,
                     const std::vector<std::string>& joints);

/// The run with verdict and the sentences of its events.
TrackRun with_sentences(TrackRun run);

/// On joints whose positions are unknown, relative to the start or not from the chain; empty where all is as wanted.
std::vector<std::string> joint_sentences(const TrackRun& run);

}  // namespace kinfer::words
