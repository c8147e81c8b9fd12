// What every orientation filter takes and may be told about its input.
#pragma once

#include "kinfer/measurement/ins_recording.hpp"

namespace kinfer {

enum class MagnetometerUse { automatic, off };  ///< automatic: where the sensor has one

}  // namespace kinfer
