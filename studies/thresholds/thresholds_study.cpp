// SPDX-License-Identifier: Apache-2.0
// What half and double of the decision thresholds that matter most do to the figures: a Markdown table, as in
// docs/development/thresholds.md. It needs a build whose thresholds can be varied, which `./dev study thresholds`
// makes.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "kinfer/base/threshold.hpp"
#include "studies/studies.hpp"
#include "studies/thresholds/calibration_figures.hpp"
#include "studies/thresholds/identification_figures.hpp"
#include "studies/thresholds/tracking_figures.hpp"

#ifndef KINFER_VARY_THRESHOLDS

int kinfer::study::run_thresholds(int, char**) {
  fmt::print(stderr, "the thresholds of this build are constants: run ./dev study thresholds\n");
  return 2;
}

#else

namespace kinfer::study::thresholds_study {
namespace {

void print_standard(const std::string& title, const Figures& standard) {
  fmt::print("\n{}:\n\n", title);
  for (const Figure& figure : standard) fmt::print("- {}: {:.4g}\n", figure.name, figure.value);
  fmt::print("\n| threshold | value | half of it | double of it |\n|---|---|---|---|\n");
}

template <class Measure>
void print_table(const std::string& title, const std::vector<std::string>& thresholds, const Measure& measure) {
  const Figures standard = measure();
  print_standard(title, standard);
  for (const std::string& name : thresholds) {
    std::string effects;
    for (const double factor : {0.5, 2.0}) {
      scale_threshold(name, factor);
      effects += fmt::format(" {} |", changes(standard, measure()));
    }
    scale_threshold(name, 1.0);
    fmt::print("| `{}` | {} |{}\n", name, threshold_value(name), effects);
    std::fflush(stdout);
  }
}

/// The thresholds of `room`, in alphabetical order.
std::vector<std::string> thresholds_of(std::string_view room) {
  std::vector<std::string> names;
  for (const std::string& name : threshold_names())
    if (name.starts_with(room)) names.push_back(name);
  return names;
}

}  // namespace
}  // namespace kinfer::study::thresholds_study

int kinfer::study::run_thresholds(int, char**) {
  using namespace thresholds_study;
  const auto recordings = simulated_recordings();
  print_table("Identification of twelve simulated recordings", thresholds_of("identify"),
              [&] { return identification_figures(recordings); });
  const auto robots = measured_robots();
  print_table(fmt::format("Calibration of {} robots", robots.size()), thresholds_of("calibrate"),
              [&] { return calibration_figures(robots); });
  const auto drives = tracked_drives();
  print_table(fmt::format("Tracking of {} drives", drives.size()), thresholds_of("track"),
              [&] { return tracking_figures(drives); });
  return 0;
}

#endif
