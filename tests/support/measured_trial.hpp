// SPDX-License-Identifier: Apache-2.0
// Measured recordings with a reference orientation (KINFER_DATA, docs/development/methods/orientation.md).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinfer/io/recording/ins_csv.hpp"
#include "kinfer/io/text/csv.hpp"
#include "kinfer/io/text/text_file.hpp"

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
  const NumericTable table = parse_numeric_csv(text, truth.string()).value();
  const auto column = [&](const std::string& name) -> const std::vector<double>* {
    for (std::size_t i = 0; i < table.header.columns.size(); ++i)
      if (table.header.columns[i] == name) return &table.columns[i];
    return nullptr;
  };
  const auto *w = column(sensor + "qw"), *x = column(sensor + "qx"), *y = column(sensor + "qy"),
             *z = column(sensor + "qz");
  const auto* movement = column("movement");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    trial.truth.emplace_back((*w)[row], (*x)[row], (*y)[row], (*z)[row]);
    trial.moves.push_back(movement == nullptr || (*movement)[row] > 0.5);
  }
  return trial;
}

inline MeasuredTrial read_broad(const std::filesystem::path& folder) {
  return read_trial(folder / "imu.csv", folder / "truth.csv", "");
}

}  // namespace kinfer::testing
