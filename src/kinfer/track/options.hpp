// SPDX-License-Identifier: Apache-2.0
// What the user states about a tracking run. Its rows (InsRow) hold one sample for each sensor of the model, in the
// model's order.
#pragma once

#include <optional>

#include "kinfer/linalg/types.hpp"
#include "kinfer/measurement/ins_row.hpp"

namespace kinfer::track {

enum class BaseMotion { automatic, still, moving };

struct TrackOptions {
  BaseMotion base = BaseMotion::automatic;
  /// [rad] or [m], one per joint position; NaN: unknown. Where the machine is when tracking begins.
  std::optional<VectorXd> start{};
};

}  // namespace kinfer::track
