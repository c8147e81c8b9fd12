// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/identification/chain_update.hpp"

namespace kinfer {

std::string_view name(ChainChangeKind kind) {
  return kind == ChainChangeKind::sensor_moved ? "sensor_moved" : "joint_moved";
}

std::string_view name(ChainPartQuantity quantity) {
  return quantity == ChainPartQuantity::axis ? "axis" : "point";
}

}  // namespace kinfer
