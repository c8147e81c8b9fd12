// SPDX-License-Identifier: Apache-2.0
// kinfer merge: the results of sweeps side by side: table, report, and the population as a prior.
#include "kinfer/fleet/merge.hpp"

#include <memory>

#include "kinfer/cli/parts/output_folder.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/sweep/read_runs.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/fleet/fleet_json.hpp"
#include "kinfer/io/fleet/fleet_table.hpp"
#include "kinfer/report/report.hpp"
#include "kinfer/words/fleet/fleet.hpp"

namespace kinfer::cli {
namespace {

struct MergeArguments {
  std::vector<std::string> runs;
  std::string out;
  bool quiet = false;
};

Result<void> write_fleet(OutputFolder& folder, const Fleet& fleet) {
  for (const auto& [name, text] :
       {std::pair{"table.csv", format_fleet_table(fleet.rows)}, std::pair{"fleet.json", format_fleet(fleet)},
        std::pair{"report.html", report::report_html(fleet)}})
    if (auto done = write_text_file(folder / name, text); !done) return done;
  if (fleet.population) return write_text_file(folder / "prior.json", format_population(*fleet.population));
  std::error_code ignored;
  std::filesystem::remove(folder.visible("prior.json"), ignored);  // of an earlier merge
  return {};
}

void print_fleet(const Fleet& fleet) {
  constexpr std::size_t most = 8;
  std::string text = words::headline(fleet.counts) + "\n";
  for (const std::string& remark : words::remarks(fleet)) text += "  - " + remark + "\n";
  const auto add = [&](const char* title, const auto& list) {
    if (list.empty()) return;
    text += fmt::format("{}\n", title);
    for (std::size_t i = 0; i < std::min(most, list.size()); ++i) text += "  - " + words::sentence(list[i]) + "\n";
    if (list.size() > most) text += fmt::format("  - and {} more (fleet.json lists all)\n", list.size() - most);
  };
  add("Unusual:", fleet.deviations);
  add("Changed:", fleet.chart.alarms);
  print_summary(text, Tone::neutral);
}

int run(const MergeArguments& options) {
  auto rows = read_runs(options.runs);
  if (!rows) return fail(rows.error());
  read_information(*rows, fleet::rows_of_prior(*rows));
  auto folder = OutputFolder::make(options.out);
  if (!folder) return fail(folder.error());
  const Fleet fleet = fleet::merge_rows(std::move(*rows));
  if (auto done = write_fleet(*folder, fleet); !done) return fail(done.error());
  if (auto done = folder->commit(); !done) return fail(done.error());
  if (!options.quiet) print_fleet(fleet);
  return exit_done;
}

}  // namespace

Verb add_merge(CLI::App& app) {
  CLI::App* verb =
      add_command(app, "merge", "The results of a sweep side by side: table, report, prior of the fleet",
                  "The same bytes whatever engine ran the sweep, in any order and number of shards. Example:\n"
                  "  kinfer merge runs --out fleet\n"
                  "  kinfer calibrate --robot robot.toml --data poses.csv --prior fleet --out new");
  auto options = std::make_shared<MergeArguments>();
  add_texts(*verb, "runs", options->runs, "Folders of `kinfer sweep`", Requirement::required, "RUNS");
  add_text(*verb, "--out", options->out, "Folder for table.csv, fleet.json, report.html, prior.json",
           Requirement::required, "DIR");
  add_quiet_option(*verb, options->quiet);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
