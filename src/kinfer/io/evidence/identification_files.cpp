// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/identification_files.hpp"

#include "kinfer/io/evidence/chain_dh_csv.hpp"
#include "kinfer/io/robot/mjcf.hpp"
#include "kinfer/io/robot/urdf.hpp"

namespace kinfer {

std::vector<OutputFile> identification_files(const Identification& identification) {
  return {{"chain.toml", format_robot_toml(RobotModel{.chain = identification.chain})},
          {"chain.urdf", format_urdf(identification.chain)},
          {"chain.mjcf", format_mjcf(identification.chain)},
          {"chain_dh.csv", format_chain_dh_csv(identification.dh)}};
}

}  // namespace kinfer
