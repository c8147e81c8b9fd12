// SPDX-License-Identifier: Apache-2.0
// Any robot, any instrument: calibration errors on simulated robots with known truth and, where KINFER_DATA is set, on
// public measured sets.
//
//   ./dev study robots [simulated|real|all]
#include <cstdlib>
#include <cstring>

#include "real.hpp"
#include "simulated.hpp"
#include "studies/studies.hpp"
#include "studies/support/table.hpp"

int kinfer::study::run_robots(int argc, char** argv) {
  const std::string part = argc > 1 ? argv[1] : "all";
  if (part != "real") robots_study::simulated_robots();
  if (part == "simulated") return 0;
  if (const char* data = std::getenv("KINFER_DATA"))
    robots_study::real_robots(data, argc > 2 ? argv[2] : "");
  else
    fmt::print("\nReal robots: KINFER_DATA is not set.\n");
  return 0;
}
