// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/parts/calibration_tables.hpp"

#include <algorithm>

#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/calibrate/validation/iso9283.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/io/evidence/joint_tables_csv.hpp"
#include "kinfer/io/text/format_number.hpp"
#include "kinfer/io/text/text_file.hpp"

namespace kinfer::cli {
namespace {

std::string accuracy_csv(const std::vector<PoseAccuracy>& poses) {
  std::string text = "row,rows,AP_before[mm],AP_after[mm],RP[mm]\n";
  for (const PoseAccuracy& p : poses)
    text += fmt::format("{},{},{},{},{}\n", p.rows.front(), p.rows.size(), format_number(p.accuracy_before, 1e-3),
                        format_number(p.accuracy_after, 1e-3),
                        p.repeatability ? format_number(*p.repeatability, 1e-3) : "");
  return text;
}

}  // namespace

Result<void> write_calibration_tables(const std::filesystem::path& folder, const calibrate::CalibrationTask& task,
                                      const Calibration& calibration) {
  const Estimate& estimate = calibration.estimate;
  std::vector<std::pair<const char*, std::string>> files{
      {"joint_twists.csv", format_joint_twists_csv(estimate.chain)},
      {"encoder_offsets.csv", format_encoder_offsets_csv(task.nominal, estimate)},
      {"covariance.csv", format_covariance_csv(estimate)}};
  if (const auto mdh = as_mdh(estimate.chain)) files.emplace_back("chain_mdh.csv", format_dh_table_csv(*mdh));
  if (const auto dh = as_dh(estimate.chain)) files.emplace_back("chain_dh.csv", format_dh_table_csv(*dh));
  if (!calibration.accuracy.empty()) files.emplace_back("accuracy.csv", accuracy_csv(calibration.accuracy));
  for (const auto& [name, text] : files)
    if (auto done = write_text_file(folder / name, text); !done) return done;
  return {};
}

std::string pose_accuracy_sentence(const Calibration& calibration) {
  std::vector<double> before, after, repeat;
  for (const PoseAccuracy& p : calibration.accuracy) {
    before.push_back(p.accuracy_before), after.push_back(p.accuracy_after);
    if (p.repeatability) repeat.push_back(*p.repeatability);
  }
  if (after.empty()) return "";
  const auto worst = [](const std::vector<double>& list) { return 1e3 * *std::max_element(list.begin(), list.end()); };
  std::string text = fmt::format(
      "ISO 9283 over all rows: pose accuracy AP {:.3f} mm on average and {:.3f} mm at worst ({:.3f} and {:.3f} mm "
      "before)",
      1e3 * mean(after), worst(after), 1e3 * mean(before), worst(before));
  if (!repeat.empty())
    text += fmt::format("; repeatability RP {:.3f} mm on average and {:.3f} mm at worst over {} repeated pose{}",
                        1e3 * mean(repeat), worst(repeat), repeat.size(), repeat.size() == 1 ? "" : "s");
  return text;
}

}  // namespace kinfer::cli
