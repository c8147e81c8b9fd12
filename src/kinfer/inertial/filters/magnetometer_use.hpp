// SPDX-License-Identifier: Apache-2.0
// Input settings shared by all orientation filters.
#pragma once

#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

enum class MagnetometerUse { automatic, off };  ///< automatic: used if the sensor has one

}  // namespace kinfer
