// SPDX-License-Identifier: Apache-2.0
// What the user states about a tracking run. Its rows (InsRow) hold one sample for each sensor of the model, in the
// model's order.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/linalg/types.hpp"
#include "kinfer/measurement/ins/ins_row.hpp"

namespace kinfer::track {

enum class BaseMotion { automatic, still, moving };

struct TrackOptions {
  BaseMotion base = BaseMotion::automatic;
  /// [rad] or [m], one per joint position; NaN: unknown. Where the machine is when tracking begins.
  std::optional<VectorXd> start{};
};

enum class Estimator {
  filter,   ///< Tracker: each row as soon as it is there
  smoother  ///< smooth(): after the last row
};

/// As the program's options state them, for provenance; angles in deg, lengths in mm.
std::vector<std::pair<std::string, std::string>> describe(const TrackOptions& options, Estimator estimator,
                                                          const TrackingModel& model);

}  // namespace kinfer::track
