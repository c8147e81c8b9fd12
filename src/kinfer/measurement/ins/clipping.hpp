// SPDX-License-Identifier: Apache-2.0
// What a clipped sample says: on the clipped axes the truth is at least (or at most) the value, on the others it is the
// value.
#pragma once

#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// +1: the truth is at least the value; −1: at most; 0: measured. Of the three axes.
using ClippedSides = std::array<std::int8_t, 3>;
inline constexpr ClippedSides unclipped{};

/// Range of the instrument whose rows carry `fault`: the smallest peak of the clipped rows; 0 if none is clipped.
double clipping_range(const InsSensor& sensor, const TriadColumns& triad, Fault fault);

/// Of one row; `range` as above.
ClippedSides clipped_sides(const InsSensor& sensor, const TriadColumns& triad, Fault fault, double range,
                           std::size_t row);

}  // namespace kinfer
