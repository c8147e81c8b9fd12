// SPDX-License-Identifier: Apache-2.0
// kinfer track: an identified chain at work; joint positions, tool pose and alarms from INS samples, row by row.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "kinfer/base/angle.hpp"
#include "kinfer/cli/parts/arguments.hpp"
#include "kinfer/cli/parts/evidence_files.hpp"
#include "kinfer/cli/parts/expected_cost.hpp"
#include "kinfer/cli/parts/run_record.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/tracking/row_source.hpp"
#include "kinfer/cli/tracking/start_argument.hpp"
#include "kinfer/cli/tracking/track_output.hpp"
#include "kinfer/cli/tracking/track_summary.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/evidence/fingerprints.hpp"
#include "kinfer/io/evidence/track_json.hpp"
#include "kinfer/io/text/csv.hpp"
#include "kinfer/io/text/possible_range.hpp"
#include "kinfer/io/tracking/tracked_chain.hpp"
#include "kinfer/track/rows/row_feed.hpp"
#include "kinfer/track/run_recorder.hpp"
#include "kinfer/track/smooth/smoother.hpp"
#include "kinfer/track/tracker.hpp"

namespace kinfer::cli {
namespace {

struct TrackArguments {
  CommonOptions common;
  std::string chain, out, start, facts, base = "auto", base_at;
  std::vector<std::string> logs;
  bool follow = false, smooth = false;
  double reorder = 0.0;
};

track::Estimator estimator_of(const TrackArguments& options) {
  return options.smooth ? track::Estimator::smoother : track::Estimator::filter;
}

Result<track::TrackOptions> track_options(const TrackArguments& options, const Chain& chain) {
  track::TrackOptions how;
  how.base = options.base == "still"    ? track::BaseMotion::still
             : options.base == "moving" ? track::BaseMotion::moving
                                        : track::BaseMotion::automatic;
  if (options.start.empty()) return how;
  KINFER_TRY(start, parse_start(options.start, chain));
  how.start = start;
  return how;
}

/// "X,Y,Z,HEADING" in mm and deg.
Result<std::optional<BasePlace>> parse_place(const std::string& text) {
  if (text.empty()) return std::optional<BasePlace>{};
  std::array<double, 4> numbers{};
  std::size_t begin = 0, count = 0;
  for (; begin <= text.size() && count < 4; ++count) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const auto number = parse_number(std::string_view(text).substr(begin, end - begin));
    if (!number || !std::isfinite(*number)) break;
    numbers[count] = *number;
    begin = end + 1;
  }
  if (count != 4 || begin <= text.size())
    return error("--base-at {}: expected X,Y,Z,HEADING in mm and deg, as 1000,0,250,90", text);
  for (std::size_t k = 0; k < numbers.size(); ++k)
    if (const auto wrong = impossible(numbers[k] * (k < 3 ? 1e-3 : degree), k < 3 ? possible::length : possible::angle))
      return error("--base-at {}: {}", text, *wrong);
  return std::optional(BasePlace{1e-3 * Vec3(numbers[0], numbers[1], numbers[2]), numbers[3] * degree});
}

Provenance provenance_of(const TrackArguments& options, const track::TrackOptions& how, const TrackingModel& model) {
  std::vector<std::string> inputs = ChainFiles(options.chain).names();
  for (const std::string& log : options.logs)
    if (log != "-") inputs.push_back(log);
  if (!options.facts.empty()) inputs.push_back(options.facts);
  Provenance provenance{.inputs = fingerprints(inputs),
                        .options = track::describe(how, estimator_of(options), model),
                        .seed = options.common.seed};
  if (options.reorder > 0.0) provenance.options.emplace_back("--reorder", fmt::format("{:g}", options.reorder));
  if (!options.base_at.empty()) provenance.options.emplace_back("--base-at", options.base_at);
  return provenance;
}

/// Whoever takes the states of a run.
struct StateSink {
  std::function<void(const TrackState&)> add;
  std::function<void()> flush;
};

RowSource row_source(const TrackArguments& options, const TrackingModel& model) {
  RowSource source{.logs = options.logs,
                   .mode = options.follow ? ReadMode::follow : ReadMode::once,
                   .times = options.reorder > 0.0 ? RowTimes::any : RowTimes::increasing};
  for (const TrackingSensor& sensor : model.sensors) source.sensors.push_back(sensor.name);
  return source;
}

/// The source's rows in order of time, clocks corrected. Returns remarks on the logs.
Result<std::vector<std::string>> each_ordered_row(const TrackArguments& options, const TrackingModel& model,
                                                  const RowSink& sink) {
  track::RowFeed feed(model, 1e-3 * options.reorder);
  KINFER_TRY(remarks, each_row(row_source(options, model),
                               {[&](const InsRow& row) { return feed.add(row, sink.row); }, sink.pause}));
  if (auto done = feed.finish(sink.row); !done) return forward_error(done.error());
  if (feed.dropped() > 0)
    remarks.push_back(
        fmt::format("{} rows came more than {:g} ms late and were left out", feed.dropped(), options.reorder));
  return remarks;
}

/// Each row's state as soon as the row is there.
Result<std::vector<std::string>> track_rows(const TrackArguments& options, const TrackingModel& model,
                                            const track::TrackOptions& how, const StateSink& sink) {
  track::Tracker tracker(model, how);
  const auto add = [&](const InsRow& row) -> Result<void> {
    tracker.add(row);
    sink.add(tracker.state());
    return {};
  };
  return each_ordered_row(options, model, {add, sink.flush});
}

/// The states after all rows have been read.
Result<std::vector<std::string>> smooth_rows(const TrackArguments& options, const TrackingModel& model,
                                             const track::TrackOptions& how, const StateSink& sink) {
  constexpr std::size_t check_every = 1 << 16;
  const auto sensors = static_cast<double>(model.sensors.size());
  std::vector<InsRow> rows;
  const auto add = [&](const InsRow& row) -> Result<void> {
    rows.push_back(row);
    if (rows.size() % check_every != 0) return {};
    return check_cost(cost_of_smoothing(static_cast<double>(rows.size()), sensors));
  };
  KINFER_TRY(remarks, each_ordered_row(options, model, {add, [] {}}));
  ProgressLine progress(options.common);
  track::smooth(model, how, rows, sink.add, progress.observer());
  return remarks;
}

Result<TrackRun> track_log(const TrackArguments& options, const TrackedChain& machine, const track::TrackOptions& how,
                           const std::vector<TrackOutput*>& outputs) {
  track::RunRecorder recorder(machine.model);
  const StateSink sink{[&](const TrackState& state) {
                         recorder.add(state);
                         for (TrackOutput* output : outputs) output->add(state);
                       },
                       [&] {
                         for (TrackOutput* output : outputs) output->flush();
                       }};
  KINFER_TRY(remarks, options.smooth ? smooth_rows(options, machine.model, how, sink)
                                     : track_rows(options, machine.model, how, sink));
  sink.flush();
  TrackRun run = recorder.run();
  run.remarks = remarks;
  return run;
}

int finish(const TrackArguments& options, const RunRecord& record, const TrackRun& run, OutputFolder* folder) {
  if (folder) {
    if (auto done = write_evidence(*folder, run); !done) return fail(done.error());
    if (auto done = record.write(*folder); !done) return fail(done.error());
    if (auto done = folder->commit(); !done) return fail(done.error());
  }
  if (!options.common.quiet) {
    const std::string summary = track_summary(run);
    if (!options.out.empty() && !options.common.json)
      print_summary(summary, tone_of(run.verdict.usability));
    else
      print_message("{}", summary);
  }
  return run.verdict.usability == Usability::do_not_use ? exit_do_not_use : exit_done;
}

int run(const TrackArguments& options) {
  if (options.smooth && options.follow)
    return fail({"--smooth needs the whole log: it cannot be combined with --follow"});
  // Its evidence.json and report.html would take the place of those of the identification.
  if (auto other = expect_other_file(options.out, {ChainFiles(options.chain).chain.parent_path().string()}); !other)
    return fail(other.error());
  RunRecord record("track", options.common);
  record.add_input(options.chain);
  for (const std::string& log : options.logs) record.add_input(log);
  const auto machine = read_tracked_chain(options.chain, options.facts);
  if (!machine) return fail(machine.error());
  const auto how = track_options(options, machine->chain);
  if (!how) return fail(how.error());
  const auto place = parse_place(options.base_at);
  if (!place) return fail(place.error());
  TrackOutput table(TrackRowWriter(machine->model, *place), RowFormat::csv),
      lines(TrackRowWriter(machine->model, *place), RowFormat::json_lines);
  std::vector<TrackOutput*> outputs;
  std::optional<OutputFolder> folder;
  if (!options.out.empty()) {
    auto made = record.open_folder(options.out);
    if (!made) return fail(made.error());
    folder.emplace(std::move(*made));
    if (auto done = table.open(options.follow ? folder->visible("track.csv") : *folder / "track.csv"); !done)
      return fail(done.error());
    outputs.push_back(&table);
  }
  if (options.out.empty() || options.common.json) {
    TrackOutput& terminal = options.common.json ? lines : table;
    if (auto done = terminal.open({}); !done) return fail(done.error());
    outputs.push_back(&terminal);
  }
  const auto tracked = track_log(options, *machine, *how, outputs);
  if (!tracked) return fail(tracked.error());
  if (auto done = table.close(); !done) return fail(done.error());
  const TrackRun evidence = track_evidence(*tracked, provenance_of(options, *how, machine->model));
  return finish(options, record, evidence, folder ? &*folder : nullptr);
}

}  // namespace

Verb add_track(CLI::App& app) {
  CLI::App* verb = add_command(
      app, "track", "Joint positions and tool pose of an identified machine at work, row by row",
      "Reads chain.toml and track.toml, which kinfer identify wrote, and a log of the same sensors. Without --out "
      "rows\n"
      "go to standard output. Positions are in deg and mm, poses in the frame of the base's sensor (docs/formats.md).\n"
      "Examples:\n"
      "  kinfer track excavator work.csv --out work\n"
      "  kinfer track excavator work.csv --out work --start 0,-31.5,23,63,40\n"
      "  kinfer track excavator work.csv --out work --smooth\n"
      "  logger | kinfer track excavator - --json\n"
      "  kinfer track excavator growing.csv --follow --out work");
  auto options = std::make_shared<TrackArguments>();
  add_text(*verb, "chain", options->chain, "Folder that kinfer identify wrote, or chain.toml in it",
           Requirement::required, "DIR");
  add_texts(*verb, "logs", options->logs, "INS recordings of the same sensors, one a logger; -: standard input",
            Requirement::required, "LOG");
  add_text(*verb, "--out", options->out, "Folder for track.csv, evidence.json, report.html, run.json",
           Requirement::optional, "DIR");
  add_flag(*verb, "--follow", options->follow, "At the end of the log wait for more, until interrupted (Ctrl-C)");
  add_number(*verb, "--reorder", options->reorder, 0.0, 60e3,
             "Rows may come so much too late [ms]: each is held back for as long, and put in order of time");
  add_flag(*verb, "--smooth", options->smooth,
           "Use what comes after each row, too: better positions, once the whole log has been read");
  add_choice(*verb, "--base", options->base, {"auto", "still", "moving"},
             "Whether the base stands still; auto: by its sensor");
  add_text(*verb, "--start", options->start,
           "Joint positions where the log begins, in deg and mm; nan: unknown (default: by gravity)",
           Requirement::optional, "LIST");
  add_text(
      *verb, "--facts", options->facts,
      "Where the tool is: the place named tip or tool, with xyz in its sensor's frame (default: as the chain says)",
      Requirement::optional, "TOML");
  add_text(
      *verb, "--base-at", options->base_at,
      "Point of the base's sensor in the world and heading of its x axis when tracking begins, X,Y,Z,HEADING in mm "
      "and deg: adds the tool's pose in the world, for a base that keeps its place",
      Requirement::optional, "LIST");
  add_common_options(*verb, options->common);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
