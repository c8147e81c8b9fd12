// SPDX-License-Identifier: Apache-2.0
// Measured recordings with a reference orientation (KINFER_DATA, docs/development/methods/orientation.md).
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/recording/ins_csv.hpp"
#include "kinfer/io/text/csv.hpp"

namespace kinfer::testing {

struct MeasuredTrial {
  InsRecording recording;
  std::vector<Quat> truth;
  std::vector<char> moves;
};

/// Columns of a truth file; `sensor` is the prefix of its quaternion columns, "" for none.
inline MeasuredTrial read_trial(const std::filesystem::path& imu, const std::filesystem::path& truth,
                                const std::string& sensor) {
  MeasuredTrial trial;
  trial.recording = read_ins_csv(imu).value();
  const std::string text = read_text_file(truth).value();
  const CsvTable table = split_csv(text, truth.string()).value();
  const auto& names = table.header.columns;
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
  };
  const std::size_t w = column(sensor + "qw"), x = column(sensor + "qx"), y = column(sensor + "qy"),
                    z = column(sensor + "qz"), movement = column("movement");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto number = [&](std::size_t k) { return parse_number(table.cell(row, k)).value_or(std::nan("")); };
    trial.truth.emplace_back(number(w), number(x), number(y), number(z));
    trial.moves.push_back(movement == names.size() || number(movement) > 0.5);
  }
  return trial;
}

inline MeasuredTrial read_broad(const std::filesystem::path& folder) {
  return read_trial(folder / "imu.csv", folder / "truth.csv", "");
}

}  // namespace kinfer::testing
