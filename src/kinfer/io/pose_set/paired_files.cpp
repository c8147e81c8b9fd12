// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/pose_set/paired_files.hpp"

#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
namespace {

/// An error where the times of a log do not rise; equal ones are left to the caller.
Result<void> expect_rising_times(const PoseSet& set, const std::string& name) {
  for (std::size_t row = 1; row < set.time.size(); ++row)
    if (set.time[row] < set.time[row - 1])
      return error("{}:{}: the time goes backwards, from {} s to {} s; is this several recordings in one file?", name,
                   set.line[row], set.time[row - 1], set.time[row]);
  return {};
}

/// Rows whose time is that of the row before are repetitions.
void drop_repeated_times(PoseLog& log, const std::string& name) {
  std::vector<int> kept;
  for (std::size_t row = 0; row < log.set.time.size(); ++row)
    if (row == 0 || log.set.time[row] > log.set.time[static_cast<std::size_t>(kept.back())])
      kept.push_back(static_cast<int>(row));
  const std::size_t repeated = log.set.time.size() - kept.size();
  if (repeated == 0) return;
  log.set = select(log.set, kept);
  log.remarks.push_back(fmt::format("{}: {} rows have the time of the row before and are not used", name, repeated));
}

/// One file with times that rise.
Result<PoseLog> read_side(const std::filesystem::path& path, const Chain& chain, const PoseLogChoice& choice,
                          RequiredContent required) {
  KINFER_TRY(log, read_pose_log(path, chain, choice, required));
  if (auto rising = expect_rising_times(log.set, path.string()); !rising) return forward_error(rising.error());
  drop_repeated_times(log, path.string());
  return log;
}

}  // namespace

Result<PairedFiles> read_paired_files(const PairedSources& sources, const Chain& chain, const PairingOptions& options) {
  PairedFiles found;
  KINFER_TRY(joints, read_side(sources.joints, chain, sources.joint_choice, RequiredContent::joints_only));
  KINFER_TRY(measured, read_side(sources.measured, chain, sources.measured_choice, RequiredContent::targets));
  found.joints = std::move(joints);
  found.measured = std::move(measured);
  found.lists = {.joints = joint_rests(found.joints.set), .measured = measured_rests(found.measured.set)};
  if (options.has_model)
    for (const Rest& rest : found.lists.joints) found.lists.predicted.push_back(forward(chain, rest.mean).position);
  const std::string names = fmt::format("{}, {}", sources.joints.string(), sources.measured.string());
  auto pairing = pair_rests(found.lists, options.method, options.offset);
  if (!pairing) return error("{}: {}", names, pairing.error().what);
  if (options.offset && pairing->method != PairingMethod::time)
    return error("--offset: no effect on pairing by {}", name(pairing->method));
  found.pairing = std::move(*pairing);
  found.set = paired_set(found.joints.set, found.measured.set, found.lists, found.pairing);
  return found;
}

std::string place_of_rest(const PoseSet& set, const Rest& rest) {
  const auto line = [&](int row) { return set.line[static_cast<std::size_t>(row)]; };
  std::string text = rest.name.empty() ? "" : fmt::format("{}, ", rest.name);
  text += rest.rows == 1 ? fmt::format("line {}", line(rest.first_row))
                         : fmt::format("lines {} to {}", line(rest.first_row), line(rest.first_row + rest.rows - 1));
  if (rest.end > 0.0) text += fmt::format(", {:.2f} s to {:.2f} s", rest.begin, rest.end);
  return text;
}

}  // namespace kinfer
