// SPDX-License-Identifier: Apache-2.0
// What changed on a machine between two identifications of it: the older chain and a newer log.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinfer {

enum class ChainChangeKind {
  sensor_moved,  ///< a sensor sits otherwise on its segment: all that is expressed in its frame moves as one
  joint_moved    ///< a joint's axis or centre is elsewhere on one of its two segments
};
std::string_view name(ChainChangeKind kind);  ///< "sensor_moved", "joint_moved"

/// The size of a change.
struct ChangeSize {
  double value = 0.0, sd = 0.0;  ///< [rad] or [m]
};

/// A single cause of differences between two identifications.
struct ChainChange {
  ChainChangeKind kind{};
  std::string name{};         ///< the sensor, or the joint as "ins1-ins2"
  std::string segment{};      ///< sensor of the segment on which it moved: the sensor itself, or one of the joint's two
  std::string alternative{};  ///< a joint whose move on this segment would look the same; empty: none would
  std::optional<ChangeSize> angle{}, distance{};  ///< none: the two logs together do not tell
  double log_odds = 0.0;                          ///< ln of the posterior odds against no change
};

enum class ChainPartQuantity { axis, point };
std::string_view name(ChainPartQuantity quantity);  ///< "axis", "point"

/// A joint's axis direction or its point in the frame of one of its sensors: how far both identifications lie apart.
struct ChainPartComparison {
  std::string joint{}, sensor{};
  ChainPartQuantity quantity{};
  double difference = 0.0;        ///< [rad] or [m]
  double sd = 0.0;                ///< rms of the difference that both standard deviations let expect
  double squared_distance = 0.0;  ///< Mahalanobis, of `freedom` degrees of freedom
  int freedom = 0;
};

struct ChainUpdate {
  std::vector<ChainChange> changes{};  ///< most certain first
  std::vector<ChainPartComparison> parts{};
  double squared_distance = 0.0;  ///< of all geometry together, after the changes
  int freedom = 0;                ///< its degrees of freedom
  bool is_other_machine = false;  ///< so much changed that the log is not taken for one of this machine
};

}  // namespace kinfer
