// SPDX-License-Identifier: Apache-2.0
// Recordings whose sensors took turns: each row holds the sample of one sensor, or of a few, and the cells of the
// others are empty.
#pragma once

#include <optional>

#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// A sensor that has a sample in a smaller share of its logger's rows is taken to be interleaved with others; larger
/// separates more. Losses of samples are rarer than this; two sensors in turn have half of the rows each.
inline constexpr double max_interleaved_share = 0.6;

/// The recording with a logger for each set of interleaved sensors that were sampled at the same instants, holding
/// their rows only: the time between its rows is then that between samples. The clock stays that of the file
/// (InsLogger::shared_clock). Empty if no sensor is interleaved.
std::optional<InsRecording> separate_interleaved_sensors(const InsRecording& recording);

}  // namespace kinfer
