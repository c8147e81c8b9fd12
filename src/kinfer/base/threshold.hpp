// SPDX-License-Identifier: Apache-2.0
// Decision thresholds that a study may vary. In the program they are constants; a build with KINFER_VARY_THRESHOLDS
// lets
// `./dev study thresholds` multiply each by a factor and measure what half and double of it do to the figures.
#pragma once

#ifdef KINFER_VARY_THRESHOLDS

#include <string>
#include <string_view>
#include <vector>

namespace kinfer {

/// The varied value of a threshold: registered with its own value once, at the start of the program.
double& vary_threshold(std::string_view name, double value);
/// Multiplies the registered value; factor 1 restores it. False where there is no threshold of that name.
bool scale_threshold(std::string_view name, double factor);
std::vector<std::string> threshold_names();

}  // namespace kinfer

#define KINFER_THRESHOLD(name, value) inline const double& name = ::kinfer::vary_threshold(#name, value)

#else

#define KINFER_THRESHOLD(name, value) inline constexpr double name = value

#endif
