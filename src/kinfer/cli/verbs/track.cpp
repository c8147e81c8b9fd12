// SPDX-License-Identifier: Apache-2.0
// kinfer track: an identified chain at work; joint positions, tool pose and alarms from INS samples, row by row.
#include <cmath>
#include <cstdio>
#include <memory>

#include "kinfer/cli/parts/arguments.hpp"
#include "kinfer/cli/parts/evidence_files.hpp"
#include "kinfer/cli/parts/posture_argument.hpp"
#include "kinfer/cli/parts/row_source.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/parts/track_summary.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/evidence/track_json.hpp"
#include "kinfer/io/robot/robot_toml.hpp"
#include "kinfer/io/tracking/track_rows.hpp"
#include "kinfer/io/tracking/tracking_model_toml.hpp"
#include "kinfer/track/run_recorder.hpp"
#include "kinfer/track/tracker.hpp"

namespace kinfer::cli {
namespace {

struct TrackArguments {
  CommonOptions common;
  std::string chain, out, start, base = "auto";
  std::vector<std::string> logs;
  bool follow = false;
};

struct TrackedChain {
  Chain chain;
  TrackingModel model;
};

/// The tool of chain.toml, which its user may have changed since.
void take_tool(TrackingModel& model, const Chain& chain) {
  const std::string& tip = chain.joints[static_cast<std::size_t>(chain.tip_joint())].name;
  for (const TrackingSensor& sensor : model.sensors) {
    if (sensor.name != tip) continue;
    const Pose tool = chain.tool.pose();
    if (model.tool.body != sensor.body || (model.tool.body_T_tool.position - tool.position).norm() > 1e-9)
      model.tool.sd = Vec3::Zero();
    model.tool.body = sensor.body;
    model.tool.body_T_tool = tool;
  }
}

Result<TrackedChain> read_tracked_chain(const std::string& folder) {
  const std::filesystem::path path(folder);
  if (!std::filesystem::is_directory(path))
    return error("{}: expected a folder that kinfer identify wrote, with chain.toml and track.toml", folder);
  KINFER_TRY(robot, read_robot_toml(path / "chain.toml"));
  if (!std::filesystem::exists(path / "track.toml"))
    return error(
        "{}: the chain has no tracking data, track.toml: identify the machine again, without --geometry searched",
        folder);
  KINFER_TRY(model, read_tracking_model(path / "track.toml"));
  if (position_names(model) != active_joint_names(robot.chain))
    return error("{}: chain.toml and track.toml are of different machines: their joints differ", folder);
  take_tool(model, robot.chain);
  return TrackedChain{std::move(robot.chain), std::move(model)};
}

Result<void> check_limits(const VectorXd& start, const Chain& chain) {
  const std::vector<int> joints = active_joints(chain);
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const Joint& joint = chain.joints[static_cast<std::size_t>(joints[k])];
    const double q = start[static_cast<Eigen::Index>(k)], unit = rotates(joint.type) ? degree : 1e-3;
    if (q < joint.lower || q > joint.upper)
      return error("--start: {} is {:.6g} {}, outside its limits {:.6g} to {:.6g}", joint.name, q / unit,
                   rotates(joint.type) ? "deg" : "mm", joint.lower / unit, joint.upper / unit);
  }
  return {};
}

Result<track::TrackOptions> track_options(const TrackArguments& options, const Chain& chain) {
  track::TrackOptions how;
  how.base = options.base == "still"    ? track::BaseMotion::still
             : options.base == "moving" ? track::BaseMotion::moving
                                        : track::BaseMotion::automatic;
  if (options.start.empty()) return how;
  KINFER_TRY(start, parse_posture("--start", options.start, chain));
  if (auto checked = check_limits(start, chain); !checked) return forward_error(checked.error());
  how.start = start;
  return how;
}

/// Rows of text to a file or standard output, flushed when asked.
class RowOutput {
 public:
  RowOutput(const TrackingModel& model, bool json) : writer_(model), json_(json) {}
  ~RowOutput() {
    flush();
    if (file_ && file_ != stdout) std::fclose(file_);
  }
  RowOutput(const RowOutput&) = delete;
  RowOutput& operator=(const RowOutput&) = delete;

  Result<void> open(const std::filesystem::path& path) {
    file_ = path.empty() ? stdout : std::fopen(path.c_str(), "wb");
    if (!file_) return error("{}: cannot be written", path.string());
    if (!json_) buffer_ = writer_.header();
    return {};
  }
  void add(const TrackState& state) {
    if (json_)
      writer_.append_json(state, buffer_);
    else
      writer_.append_csv(state, buffer_);
    if (buffer_.size() > most_buffered) flush();
  }
  void flush() {
    if (!file_) return;
    std::fwrite(buffer_.data(), 1, buffer_.size(), file_);
    std::fflush(file_);
    buffer_.clear();
  }

 private:
  static constexpr std::size_t most_buffered = 1 << 18;
  TrackRowWriter writer_;
  bool json_;
  std::FILE* file_ = nullptr;
  std::string buffer_;
};

Provenance provenance_of(const TrackArguments& options) {
  const std::filesystem::path chain(options.chain);
  std::vector<std::string> inputs{(chain / "chain.toml").string(), (chain / "track.toml").string()};
  for (const std::string& log : options.logs)
    if (log != "-") inputs.push_back(log);
  return {.inputs = fingerprints(inputs),
          .options = {{"--base", options.base}, {"--start", options.start}},
          .seed = options.common.seed};
}

Result<TrackRun> track_rows(const TrackArguments& options, const TrackedChain& machine, const track::TrackOptions& how,
                            const std::vector<RowOutput*>& outputs) {
  track::Tracker tracker(machine.model, how);
  track::RunRecorder recorder(machine.model);
  RowSource source{.logs = options.logs, .mode = options.follow ? ReadMode::follow : ReadMode::once};
  for (const TrackingSensor& sensor : machine.model.sensors) source.sensors.push_back(sensor.name);
  const auto add = [&](const InsRow& row) -> Result<void> {
    tracker.add(row);
    recorder.add(tracker.state());
    for (RowOutput* output : outputs) output->add(tracker.state());
    return {};
  };
  const auto flush = [&] {
    for (RowOutput* output : outputs) output->flush();
  };
  KINFER_TRY(remarks, each_row(source, {add, flush}));
  flush();
  TrackRun run = recorder.run();
  run.remarks = remarks;
  return run;
}

Tone tone_of(Usability usability) {
  return usability == Usability::use ? Tone::good : usability == Usability::use_with_care ? Tone::neutral : Tone::bad;
}

int finish(const TrackArguments& options, const RunRecord& record, const TrackRun& run) {
  if (!options.out.empty()) {
    if (auto done = write_evidence(options.out, run); !done) return fail(done.error());
    if (auto done = record.write(options.out); !done) return fail(done.error());
  }
  if (!options.common.quiet) {
    const std::string summary = track_summary(run);
    if (!options.out.empty() && !options.common.json)
      print_summary(summary, tone_of(run.verdict.usability));
    else
      fmt::print(stderr, "{}", summary);
  }
  return run.verdict.usability == Usability::do_not_use ? exit_do_not_use : exit_done;
}

int run(const TrackArguments& options) {
  RunRecord record("track", options.common);
  record.add_input(options.chain);
  for (const std::string& log : options.logs) record.add_input(log);
  const auto machine = read_tracked_chain(options.chain);
  if (!machine) return fail(machine.error());
  const auto how = track_options(options, machine->chain);
  if (!how) return fail(how.error());
  RowOutput table(machine->model, false), lines(machine->model, true);
  std::vector<RowOutput*> outputs;
  std::optional<OutputFolder> folder;
  if (!options.out.empty()) {
    auto made = OutputFolder::make(options.out);
    if (!made) return fail(made.error());
    folder.emplace(std::move(*made));
    if (auto done = table.open(*folder / "track.csv"); !done) return fail(done.error());
    outputs.push_back(&table);
  }
  if (options.out.empty() || options.common.json) {
    RowOutput& terminal = options.common.json ? lines : table;
    if (auto done = terminal.open({}); !done) return fail(done.error());
    outputs.push_back(&terminal);
  }
  const auto tracked = track_rows(options, *machine, *how, outputs);
  if (!tracked) return fail(tracked.error());
  return finish(options, record, track_evidence(*tracked, provenance_of(options)));
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
      "  logger | kinfer track excavator - --json\n"
      "  kinfer track excavator growing.csv --follow --out work");
  auto options = std::make_shared<TrackArguments>();
  add_text(*verb, "chain", options->chain, "Folder that kinfer identify wrote", Requirement::required, "DIR");
  add_texts(*verb, "logs", options->logs, "INS recordings of the same sensors, one a logger; -: standard input",
            Requirement::required, "LOG");
  add_text(*verb, "--out", options->out, "Folder for track.csv, evidence.json, report.html, run.json",
           Requirement::optional, "DIR");
  add_flag(*verb, "--follow", options->follow, "At the end of the log wait for more, until interrupted (Ctrl-C)");
  add_choice(*verb, "--base", options->base, {"auto", "still", "moving"},
             "Whether the base stands still; auto: as its sensor tells");
  add_text(*verb, "--start", options->start,
           "Joint positions where the log begins, in deg and mm; nan: unknown (default: as gravity tells)",
           Requirement::optional, "LIST");
  add_common_options(*verb, options->common);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
