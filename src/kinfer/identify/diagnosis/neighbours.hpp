// SPDX-License-Identifier: Apache-2.0
// What the other sensors of a machine say of a correction: the segment tree gets shorter with a true one.
#pragma once

#include <vector>

#include "kinfer/identify/diagnosis/mended_log.hpp"

namespace kinfer::identify {

/// [nats per row] of the segment tree; infinite if there is none.
double tree_length(const InsRecording& recording, int threads);

/// A sensor whose axes were mapped.
struct MappedSensor {
  std::size_t sensor = 0;
  InsSensor before;
};

/// Takes back, with their findings, the maps of axes without which the tree is shorter.
void withdraw_contradicted_maps(MendedLog& log, const std::vector<MappedSensor>& mapped, int threads);

}  // namespace kinfer::identify
