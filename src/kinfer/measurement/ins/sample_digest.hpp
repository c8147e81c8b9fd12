// SPDX-License-Identifier: Apache-2.0
// What a recording holds, in a few thousand characters: by it a copy is known in any file format, under any names of
// its sensors, with its times shifted, cut at its ends or in part.
//
// Every window of four consecutive samples of a sensor is hashed, values rounded far below the instruments' noise. Of
// all hashes the smallest are kept (a bottom-k sketch; Broder 1997): below the smaller one of two recordings' largest
// hash both keep all that they share.
#pragma once

#include <string>
#include <string_view>

#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// Hashes of twelve hexadecimal digits each, in ascending order. Empty where nothing ever moves or scatters.
std::string sample_digest(const InsRecording& recording);

/// Share of the samples of the shorter recording that are in the other one, too; 0 where no more agrees than chance
/// would have it.
double shared_samples(std::string_view a, std::string_view b);

}  // namespace kinfer
