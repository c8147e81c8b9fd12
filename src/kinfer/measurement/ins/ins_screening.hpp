// SPDX-License-Identifier: Apache-2.0
// Screening of recordings: flags missing values, clipped peaks and spikes. Nothing is corrected.
#pragma once

#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// Fills `sensor.faults` (one per row) from the columns: missing where an axis is not finite or beyond the range of any
/// real sensor, or where all three are exactly zero (specific force and field: a broken wire); clipped and spike as
/// below.
void flag_faults(InsSensor& sensor);

/// Rows at the end of the instrument's range. A peak value that repeats in neighbouring rows is taken as the range if
/// it is a usual full scale (2, 4, 8, 16 ... g; 125, 250, 500, 1000, 2000 ... °/s) or if more rows lie on it than an
/// unclipped signal allows. `smallest_range`: peaks up to this are never a range, since ordinary motion reaches them.
std::vector<bool> find_clipped_rows(const std::vector<float>& column, std::span<const double> full_scales,
                                    double smallest_range);

/// Spikes of up to three consecutive rows: they deviate from the rows before and after, which agree with each other, by
/// more than `floor` and by far more than the typical second difference of the column.
std::vector<bool> find_spikes(const std::vector<float>& column, double floor);

/// Start of the unusable tail of a recording: the first row after which no row has both angular rate and specific
/// force; rows() if the sensor delivers to the end.
std::size_t find_usable_end(const InsSensor& sensor);

}  // namespace kinfer
