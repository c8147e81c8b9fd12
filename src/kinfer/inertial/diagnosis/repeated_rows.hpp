// SPDX-License-Identifier: Apache-2.0
// Rows that no sensor measured: copies of the row before, or points on the straight line between two measured rows.
#pragma once

#include <vector>

#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

struct SampleOrigin {
  double repeated_share = 0.0;      ///< of the rows that change at all
  double interpolated_share = 0.0;  ///< likewise
  std::vector<bool> repeated, interpolated;
};

/// Of one instrument. Rests without noise, in which row after row is the same, do not count.
SampleOrigin sample_origin(const TriadColumns& triad);

}  // namespace kinfer
