// SPDX-License-Identifier: Apache-2.0
// Decision thresholds that a study may vary. In the program they are constants; a build with KINFER_VARY_THRESHOLDS
// lets `./dev study thresholds` multiply each by a factor and measure what half and double of it do to the figures.
#pragma once

#ifdef KINFER_VARY_THRESHOLDS

#include <string>
#include <string_view>
#include <vector>

namespace kinfer {

/// The varied value of a threshold: registered with its own value once, at the start of the program.
double& vary_threshold(std::string_view name, double value);
/// Multiplies the registered value; factor 1 restores it. The name must be one of threshold_names().
void scale_threshold(std::string_view name, double factor);
double threshold_value(std::string_view name);
std::vector<std::string> threshold_names();  ///< "identify/max_point_sd", in alphabetical order

}  // namespace kinfer

#define KINFER_THRESHOLD(room, name, value) inline const double& name = ::kinfer::vary_threshold(#room "/" #name, value)

#else

#define KINFER_THRESHOLD(room, name, value) inline constexpr double name = value

#endif
