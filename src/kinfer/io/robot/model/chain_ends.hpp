// SPDX-License-Identifier: Apache-2.0
// Where a chain begins and ends in a robot file that names its links (URDF) or bodies and sites (MJCF).
#pragma once

#include <string>

namespace kinfer {

struct ChainEnds {
  std::string base_link;  ///< empty: the root link of a URDF, the world of an MJCF
  std::string tip_link;   ///< empty: the tool where kinfer wrote the file, else the leaf at the end of the longest path
                          ///< of moving joints (first in file order)
};

}  // namespace kinfer
