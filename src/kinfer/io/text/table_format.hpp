// SPDX-License-Identifier: Apache-2.0
// How a foreign file is cut into a header and cells, as column maps say it: delimiter, decimal, skip_lines, comment,
// header.
#pragma once

#include "kinfer/io/text/csv.hpp"
#include "kinfer/io/text/toml_reader.hpp"

namespace kinfer {

/// Reads the keys from a map's top-level table; what is not said is told by the file itself.
CsvFormat read_table_format(TableReader& file);

}  // namespace kinfer
