// SPDX-License-Identifier: Apache-2.0
// Column maps of INS logs (TOML, docs/formats.md): how the file is cut into cells, which column holds which channel of
// which sensor in which unit, how the clock counts, and which way round the axes are. The presets are such maps.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/io/text/csv.hpp"

namespace kinfer {

/// A column that holds times, or one that counts rows.
struct InsClock {
  std::string column;     ///< theirs; empty: guessed
  double tick = 0.0;      ///< [s] of one count; 0: the unit of the column's header, else seconds
  std::string rate_from;  ///< word in the lines before the header after which the sampling rate stands: tick = 1 / rate
  double wraps = 0.0;     ///< the column starts again after this many counts; 0: never
};

struct InsMap {
  std::string title;                   ///< of a preset: "Movella DOT"
  std::vector<std::string> recognise;  ///< texts that the head of a file of this format holds, all of them
  std::string unlike;                  ///< text that the head of such a file never holds; empty: any may
  std::string file_word;               ///< in the name of such a file; empty: any name
  std::string refuse;                  ///< why a file of this format cannot be used; empty: it can
  CsvFormat format{automatic, automatic};
  std::string sensor;  ///< name of the sensor; "folder", or empty: that of the file
  InsClock clock;      ///< used where it has values
  InsClock counter;    ///< used where the clock has none
  std::vector<std::pair<std::string, std::string>>
      columns;                                ///< ours -> "theirs [unit]"; empty: guessed from the header
  std::array<double, 3> sign{1.0, 1.0, 1.0};  ///< of specific force, rates, field
  Mat3 axes = Mat3::Identity();               ///< rows: our x, y, z from theirs, of all instruments
  std::array<std::string, 3> units;           ///< of columns whose header states none: "g", "deg/s", "uT"
};

Result<InsMap> parse_ins_map(std::string_view text, const std::string& name_in_messages);
Result<InsMap> read_ins_map(const std::filesystem::path& path);

}  // namespace kinfer
