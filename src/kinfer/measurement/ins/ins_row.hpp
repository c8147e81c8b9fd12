// SPDX-License-Identifier: Apache-2.0
// The samples of all sensors at one instant, as they arrive while a machine works.
#pragma once

#include <functional>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// One sample for each sensor, in an order that whoever makes and takes rows agrees on; a sensor without a sample has
/// no has_*.
struct InsRow {
  double time = 0.0;  ///< [s] never decreases
  std::vector<InsSample> sensors{};
};

/// Whoever takes rows; an error ends their source.
using InsRowSink = std::function<Result<void>(const InsRow&)>;

}  // namespace kinfer
