// SPDX-License-Identifier: Apache-2.0
// Columns that seem to be in another unit than the file claims. Nothing is corrected.
#pragma once

#include <string>

#include "kinfer/measurement/ins_recording.hpp"

namespace kinfer {

/// A sentence for each instrument whose values cannot be in the unit that the file claims: gravity of 1 or 1000,
/// angular velocities beyond any real sensor, a field that exists nowhere on Earth. Empty if all is plausible.
struct UnitWarning {
  std::string sentence;  ///< "imu: gravity reads 1.00 m/s²: the file seems to be in g; write the header as imu_ax[g]"
  bool fatal = true;     ///< false: the column can be ignored
};
std::vector<UnitWarning> check_units(const InsSensor& sensor, bool field_has_unit);

}  // namespace kinfer
