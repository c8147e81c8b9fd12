// SPDX-License-Identifier: Apache-2.0
// Order statistics of numbers that a figure draws.
#pragma once

#include <vector>

namespace kinfer::report {

/// The finite values in ascending order.
std::vector<double> finite_sorted(std::vector<double> values);

/// The value at this fraction (0 .. 1) of sorted values; NaN if there are none.
double quantile(const std::vector<double>& sorted, double fraction);

/// 1, 2 or 5 times a power of ten, at most `value`; at least 1.
double round_down(double value);

}  // namespace kinfer::report
