// SPDX-License-Identifier: Apache-2.0
// Which rest of a robot belongs to which rest of a tracker: by name, by time with an unknown offset and drift of the
// clocks, or by order.
#pragma once

#include <compare>
#include <optional>
#include <string_view>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/measurement/pairing/rests.hpp"

namespace kinfer {

enum class PairingMethod { name, time, order };
/// "name", "time", "order"
std::string_view name(PairingMethod method);

struct RestPair {
  int joints = 0, measured = 0;                       ///< indices of rests
  auto operator<=>(const RestPair&) const = default;  // NOLINT(modernize-use-nullptr): a false positive
};

struct RestPairing {
  PairingMethod method = PairingMethod::order;
  std::vector<RestPair> pairs{};                      ///< in the order of the robot's rests
  std::vector<int> joints_alone{}, measured_alone{};  ///< rests without partner
  double offset = 0.0;                                ///< time: tracker minus robot at the robot's first rest [s]
  double drift = 0.0;                                 ///< [s/s]
  double timing_error = 0.0;                          ///< [s] rms of begins and ends that are left
  double distance_error = 0.0;  ///< [m] median of |distance between successive points, measured minus predicted|
};

struct RestLists {
  std::vector<Rest> joints{}, measured{};
  std::vector<Vec3> predicted{};  ///< [m] nominal tool points at `joints`, in any frame; they decide between pairings
};

/// By time with `offset` [s], tracker minus robot, where it is known; it need not be better than to half a rest.
/// Errors: names that repeat or do not meet; counts that differ, with the first place where measured and predicted
/// distances part; several offsets in time that explain the rests equally well.
Result<RestPairing> pair_by_name(const RestLists& lists);
Result<RestPairing> pair_by_time(const RestLists& lists, std::optional<double> offset = std::nullopt);
Result<RestPairing> pair_by_order(const RestLists& lists);

}  // namespace kinfer
