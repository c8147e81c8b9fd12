// SPDX-License-Identifier: Apache-2.0
// A joint log and a tracker's file in place of a pose set, shared by the verbs that match them.
#pragma once

#include <string>
#include <vector>

#include "kinfer/cli/options/robot_option.hpp"
#include "kinfer/io/pose_set/paired_files.hpp"

namespace kinfer::cli {

struct PairingOption {
  std::string joints, measured, measured_columns, marker, by = "auto";
  std::vector<std::string> topics;
  double offset = 0.0;
  bool has_offset = false;
};

/// --joints, --measured, --measured-columns, --marker, --topic, --by, --offset.
void add_pairing_options(CLI::App& verb, PairingOption& option, Requirement need);

/// Options that only pairing uses, as the user gave them: "--by", "time".
std::vector<std::pair<std::string, std::string>> given_pairing_options(const CLI::App& verb,
                                                                       const PairingOption& option);

/// `joint_columns`: column map of the joint log. `has_model`: as of PairingOptions.
Result<PairedFiles> read_paired(const PairingOption& option, const std::string& joint_columns, const Chain& chain,
                                bool has_model);

/// How the rests were matched, and those that found no partner.
std::string pairing_summary(const PairingOption& option, const PairedFiles& paired);

}  // namespace kinfer::cli
