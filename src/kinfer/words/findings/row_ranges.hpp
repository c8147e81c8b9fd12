// SPDX-License-Identifier: Apache-2.0
// Rows of a file in words.
#pragma once

#include <string>
#include <vector>

namespace kinfer::words {

/// "row 3", "rows 3, 5 and 9", "rows 12-40 and 44"; ascending rows, from 0.
std::string row_ranges(const std::vector<int>& rows);

}  // namespace kinfer::words
