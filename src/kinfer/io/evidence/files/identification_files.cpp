// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/files/identification_files.hpp"

#include "kinfer/io/evidence/files/chain_dh_csv.hpp"
#include "kinfer/io/robot/mjcf/mjcf.hpp"
#include "kinfer/io/robot/urdf/urdf.hpp"
#include "kinfer/io/tracking/tracking_model_toml.hpp"

namespace kinfer {

std::vector<OutputFile> identification_files(const Identification& identification) {
  if (dof(identification.chain) == 0) return {};
  std::vector<OutputFile> files{{"chain.toml", format_robot_toml(RobotModel{.chain = identification.chain})},
                                {"chain.urdf", format_urdf(identification.chain)},
                                {"chain.mjcf", format_mjcf(identification.chain)},
                                {"chain_dh.csv", format_chain_dh_csv(identification.dh)}};
  if (identification.tracking) files.push_back({"track.toml", format_tracking_model(*identification.tracking)});
  return files;
}

}  // namespace kinfer
