// SPDX-License-Identifier: Apache-2.0
// Accuracy of the orientation filters on measured data: ten trials of BROAD with optical truth, three runs of a UR5
// with encoders. Prints the tables of docs/development/methods/orientation.md; draws orientation.svg into the folder
// given as argument.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/parallel.hpp"
#include "kinfer/inertial/filters/orientation.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "studies/studies.hpp"
#include "support/measured_trial.hpp"
#include "support/orientation_error.hpp"

namespace {

namespace fs = std::filesystem;
using namespace kinfer;
using testing::HeadingOffset;
using testing::OrientationError;

struct NamedFilter {
  std::string name;
  FilterOptions options;
  std::string colour;
};

/// One filter on one trial, [°].
struct Score {
  double total = 0.0, heading = 0.0, inclination = 0.0;  // with magnetometer
  double free_heading = 0.0, free_inclination = 0.0;     // without; the best constant heading offset is removed
};

std::vector<NamedFilter> named_filters() {
  const std::array<std::string, 6> colours{"#3a7ca5", "#16425b", "#b0b0b0", "#d1495b", "#edae49", "#66a182"};
  std::vector<NamedFilter> filters;
  for (const OrientationFilter& filter : orientation_filters())
    filters.push_back({std::string(filter.name), filter.default_options, colours[filters.size() % colours.size()]});
  return filters;
}

struct Trial {
  std::string name;
  bool chosen = false;        // used for choosing the settings
  std::vector<Score> scores;  // one a filter
};

const std::vector<std::string> chosen_trials{"09", "15", "28"};

Score score(const testing::MeasuredTrial& trial, const FilterOptions& options) {
  const InsSensor& sensor = trial.recording.sensors[0];
  const auto& time = trial.recording.loggers[0].time;
  const OrientationError with =
      testing::orientation_error(estimate_orientations(sensor, time, options), trial.truth, trial.moves);
  const OrientationError without =
      testing::orientation_error(estimate_orientations(sensor, time, without_magnetometer(options)), trial.truth,
                                 trial.moves, HeadingOffset::best_constant);
  return {with.total / degree, with.heading / degree, with.inclination / degree, without.heading / degree,
          without.inclination / degree};
}

std::vector<Trial> broad(const fs::path& folder, const std::vector<NamedFilter>& filters) {
  std::vector<fs::path> folders(fs::directory_iterator(folder), fs::directory_iterator{});
  std::ranges::sort(folders);
  std::vector<Trial> trials(folders.size());
  parallel_for(folders.size(), 0, [&](std::size_t i) {
    const testing::MeasuredTrial measured = testing::read_broad(folders[i]);
    trials[i].name = folders[i].filename().string();
    trials[i].chosen = std::ranges::find(chosen_trials, trials[i].name.substr(0, 2)) != chosen_trials.end();
    for (const NamedFilter& filter : filters) trials[i].scores.push_back(score(measured, filter.options));
  });
  return trials;
}

enum class Which { all, chosen, others };

Score mean_score(const std::vector<Trial>& trials, std::size_t filter, Which which) {
  Score mean;
  double n = 0.0;
  for (const Trial& trial : trials) {
    if (which != Which::all && trial.chosen != (which == Which::chosen)) continue;
    const Score& s = trial.scores[filter];
    mean.total += s.total, mean.heading += s.heading, mean.inclination += s.inclination;
    mean.free_heading += s.free_heading, mean.free_inclination += s.free_inclination;
    n += 1.0;
  }
  for (double* value : {&mean.total, &mean.heading, &mean.inclination, &mean.free_heading, &mean.free_inclination})
    *value /= n;
  return mean;
}

void print_row(const std::string& name, const Score& s) {
  fmt::print("| {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n", name, s.total, s.heading, s.inclination,
             s.free_heading, s.free_inclination);
}

void print_tables(const std::vector<Trial>& trials, const std::vector<NamedFilter>& filters) {
  const std::pair<Which, const char*> groups[] = {
      {Which::all, "all ten trials"},
      {Which::chosen, "the three on which settings were chosen (09, 15, 28)"},
      {Which::others, "the seven others"}};
  for (const auto& [which, words] : groups) {
    fmt::print(
        "\nMean over {} [°]\n\n| filter | total | heading | inclination | heading, no magnetometer | inclination, no "
        "magnetometer |\n"
        "|---|---|---|---|---|---|\n",
        words);
    for (std::size_t f = 0; f < filters.size(); ++f) print_row(filters[f].name, mean_score(trials, f, which));
  }
  for (std::size_t f = 0; f < filters.size(); ++f) {
    fmt::print(
        "\n{}, trial by trial [°]\n\n| trial | total | heading | inclination | heading, no magnetometer | inclination, "
        "no magnetometer |\n"
        "|---|---|---|---|---|---|\n",
        filters[f].name);
    for (const Trial& trial : trials) print_row(trial.name, trial.scores[f]);
  }
}

void print_ur5(const fs::path& folder, const std::vector<NamedFilter>& filters) {
  fmt::print(
      "\nUR5 against its encoders, one constant rotation on each side fitted, no magnetometer, rms [°]\n\n"
      "| filter | circle-150 | circle-250 | triangle-150 | mean |\n|---|---|---|---|---|\n");
  for (const NamedFilter& filter : filters) {
    std::vector<double> errors;
    for (const char* run : {"circle-150", "circle-250", "triangle-150"}) {
      const auto trial = testing::read_trial(folder / (std::string(run) + "_imu.csv"),
                                             folder / (std::string(run) + "_truth.csv"), "radius_");
      const auto q = estimate_orientations(trial.recording.sensors[0], trial.recording.loggers[0].time, filter.options);
      errors.push_back(testing::aligned_error(q, trial.truth) / degree);
    }
    fmt::print("| {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n", filter.name, errors[0], errors[1], errors[2],
               (errors[0] + errors[1] + errors[2]) / 3.0);
  }
}

/// Bars of the total error, a group a trial, a bar a filter.
std::string figure(const std::vector<Trial>& trials, const std::vector<NamedFilter>& filters) {
  constexpr double left = 50, top = 40, height = 260, group = 78, bar = 20, per_degree = 32;  // [px]
  const double width = left + group * static_cast<double>(trials.size()) + 70, floor = top + height;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" font-family=\"sans-serif\" "
      "font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
      width, floor + 110);
  svg += fmt::format(
      "<text x=\"{}\" y=\"20\" font-size=\"14\">BROAD: total orientation error with magnetometer, rms while moving "
      "[°]</text>\n",
      left);
  for (int d = 0; d <= 8; d += 2)
    svg += fmt::format(
        "<line x1=\"{0}\" x2=\"{1:.0f}\" y1=\"{2:.0f}\" y2=\"{2:.0f}\" stroke=\"#ddd\"/><text x=\"{3}\" y=\"{4:.0f}\" "
        "text-anchor=\"end\">{5}</text>\n",
        left, width - 70, floor - per_degree * d, left - 6, floor - per_degree * d + 4, d);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const double x = left + 8 + group * static_cast<double>(i);
    for (std::size_t f = 0; f < filters.size(); ++f) {
      const double h = std::min(height, per_degree * trials[i].scores[f].total),
                   at = x + (bar + 1) * static_cast<double>(f);
      svg += fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{:.1f}\" fill=\"{}\"/><text x=\"{:.1f}\" y=\"{:.1f}\" "
          "font-size=\"9\" text-anchor=\"middle\">{:.1f}</text>\n",
          at, floor - h, bar, h, filters[f].colour, at + bar / 2, floor - h - 3, trials[i].scores[f].total);
    }
    const std::string& name = trials[i].name;
    svg += fmt::format(
        "<text x=\"{:.1f}\" y=\"{:.0f}\" transform=\"rotate(25 {:.1f} {:.0f})\" font-size=\"9\">{}{}</text>\n", x,
        floor + 14, x, floor + 14, name.substr(0, 30), trials[i].chosen ? " *" : "");
  }
  for (std::size_t f = 0; f < filters.size(); ++f)
    svg += fmt::format(
        "<rect x=\"{0:.0f}\" y=\"{1:.0f}\" width=\"10\" height=\"10\" fill=\"{2}\"/><text x=\"{3:.0f}\" "
        "y=\"{4:.0f}\">{5}</text>\n",
        left + 150.0 * static_cast<double>(f), floor + 92, filters[f].colour,
        left + 150.0 * static_cast<double>(f) + 16, floor + 102, filters[f].name);
  return svg + fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\">* settings were chosen on it</text>\n</svg>\n", left + 480,
                           floor + 102);
}

}  // namespace

int kinfer::study::run_orientation(int argc, char** argv) {
  const char* data = std::getenv("KINFER_DATA");
  if (data == nullptr) {
    fmt::print(stderr,
               "orientation: set KINFER_DATA to the folder that holds broad/ and ur5_openaxes/ "
               "(docs/development/methods/orientation.md)\n");
    return 2;
  }
  const std::vector<NamedFilter> filters = named_filters();
  const std::vector<Trial> trials = broad(fs::path(data) / "broad", filters);
  print_tables(trials, filters);
  print_ur5(fs::path(data) / "ur5_openaxes", filters);
  if (argc < 2) return 0;
  const auto done = write_text_file(fs::path(argv[1]) / "orientation.svg", figure(trials, filters));
  if (!done) fmt::print(stderr, "orientation: {}\n", done.error().what);
  return done ? 0 : 2;
}
