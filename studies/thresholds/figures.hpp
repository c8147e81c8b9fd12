// SPDX-License-Identifier: Apache-2.0
// Figures of merit of a set of runs, and how they change.
#pragma once

#include <string>
#include <vector>

namespace kinfer::study::thresholds_study {

struct Figure {
  std::string name;  ///< "axis lines, median [mm]"
  double value = 0.0;
};
using Figures = std::vector<Figure>;

/// The figures that differ by more than one per cent: "axis lines, median [mm] 1.2 → 1.6"; "no change" if none does.
std::string changes(const Figures& standard, const Figures& varied);

}  // namespace kinfer::study::thresholds_study
