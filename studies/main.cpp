// SPDX-License-Identifier: Apache-2.0
// `./dev study NAME [arguments]`: writes the tables and figures of one study.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "studies/studies.hpp"

namespace kinfer::study {
namespace {

struct NamedStudy {
  std::string_view name;
  int (*run)(int argc, char** argv);
};

constexpr std::array studies{
    NamedStudy{"azimuth", run_azimuth},
    NamedStudy{"clipping", run_clipping},
    NamedStudy{"coverage", run_coverage},
    NamedStudy{"diodem", run_diodem},
    NamedStudy{"fleet", run_fleet},
    NamedStudy{"identify", run_identify},
    NamedStudy{"lengths", run_lengths},
    NamedStudy{"log_faults", run_log_faults},
    NamedStudy{"loops", run_loops},
    NamedStudy{"noise", run_noise},
    NamedStudy{"orientation", run_orientation},
    NamedStudy{"paper1", run_paper1},
    NamedStudy{"paper2", run_paper2},
    NamedStudy{"planning", run_planning},
    NamedStudy{"reach", run_reach},
    NamedStudy{"regret", run_regret},
    NamedStudy{"robots", run_robots},
    NamedStudy{"search_start", run_search_start},
    NamedStudy{"structure", run_structure},
    NamedStudy{"thresholds", run_thresholds},
    NamedStudy{"track", run_track},
    NamedStudy{"update", run_update},
    NamedStudy{"verdict", run_verdict},
};

int run_named(int argc, char** argv) {
  const std::string_view name = argc > 1 ? argv[1] : "";
  const auto found = std::ranges::find(studies, name, &NamedStudy::name);
  if (found != studies.end()) return found->run(argc - 1, argv + 1);
  fmt::print(stderr, "usage: studies NAME [arguments], one of:");
  for (const NamedStudy& study : studies) fmt::print(stderr, " {}", study.name);
  fmt::print(stderr, "\n");
  return 2;
}

}  // namespace
}  // namespace kinfer::study

int main(int argc, char** argv) {
  return kinfer::study::run_named(argc, argv);
}
