// Marks what a recording's numbers cannot mean: rows without a number, clipped peaks, spikes, and says which
// columns seem to be in another unit. Marks, never mends.
#pragma once

#include <string>

#include "kinfer/measurement/ins_recording.hpp"

namespace kinfer {

/// Fills `sensor.faults` (one a row) from the columns: missing where an axis is not finite or beyond what any
/// sensor can say, or all three are exactly zero (specific force and field: a broken wire, not physics); clipped and
/// spike as below.
void mark_faults(InsSensor& sensor);

/// Rows at the end of the range of the instrument. A peak value that repeats in neighbouring rows is the range where it
/// is a usual full scale (2, 4, 8, 16 ... g; 125, 250, 500, 1000, 2000 ... °/s) or where the rows pile up on it as no
/// unclipped signal does. `smallest_range`: what cannot be a range, because ordinary readings reach it.
std::vector<bool> clipped_rows(const std::vector<float>& column, std::span<const double> full_scales,
                               double smallest_range);

/// Rows, up to three together, that leave the rows beside them, which agree, by more than `floor` and by far more than
/// the column usually bends.
std::vector<bool> spike_rows(const std::vector<float>& column, double floor);

/// A sentence for each instrument whose numbers cannot be in the unit that the file claims: gravity of 1 or 1000,
/// rates that no such sensor can measure, a field no place on Earth has. Empty where all is plausible.
struct UnitDoubt {
  std::string sentence;  ///< "imu: gravity reads 1.00 m/s²: the file seems to be in g; write the header as imu_ax[g]"
  bool fatal = true;     ///< false: the column can be left out
};
std::vector<UnitDoubt> unit_doubts(const InsSensor& sensor, bool field_has_unit);

/// First row from which on the sensor says nothing that can be used any more (no rate or no specific force); rows()
/// where it lives to the end.
std::size_t death_row(const InsSensor& sensor);

}  // namespace kinfer
