// SPDX-License-Identifier: Apache-2.0
// kinfer identify: INS logs of an unknown machine -> order of its segments, chain, evidence.
#include "kinfer/identify/pipeline.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "kinfer/cli/options/drive_choices.hpp"
#include "kinfer/cli/options/zero_argument.hpp"
#include "kinfer/cli/parts/arguments.hpp"
#include "kinfer/cli/parts/evidence_files.hpp"
#include "kinfer/cli/parts/expected_cost.hpp"
#include "kinfer/cli/parts/identification_summary.hpp"
#include "kinfer/cli/parts/ins_logs.hpp"
#include "kinfer/cli/parts/run_record.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/sweep/task_context.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/evidence/chain_recordings.hpp"
#include "kinfer/io/evidence/files/identification_files.hpp"
#include "kinfer/io/evidence/fingerprints.hpp"
#include "kinfer/io/evidence/identification_json.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/recording/machine_facts_toml.hpp"
#include "kinfer/io/tracking/tracked_chain.hpp"

namespace kinfer::cli {
namespace {

/// Settings of a search engine; its own defaults where not given.
struct EngineArguments {
  std::string engine = "bmp", terminals = "hinge", pairing = "halves";
  std::optional<int> individuals, generations, clones, cycles, transfers;
  std::optional<int> min_depth, max_depth, max_leaves, rows;
};

struct IdentifyArguments {
  CommonOptions common;
  std::vector<std::string> logs, topics;
  std::string out, filter = "kinfer-offline", root;
  double smoothing = SegmentMotionOptions{}.smoothing;
  EngineArguments search;
  int links = 0;
  std::string geometry = "refined", grade = "auto", facts, sensors, tree, zero, columns, update;
};

std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> items;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    items.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return items;
}

/// "ins0-ins1,ins1-ins2"; a colon separates names that contain hyphens.
Result<std::vector<identify::GivenLink>> parse_links(const std::string& text) {
  std::vector<identify::GivenLink> links;
  for (const std::string& item : split_at_commas(text)) {
    const std::size_t colon = item.find(':'), at = colon != std::string::npos ? colon : item.find('-');
    if (at == std::string::npos) return error("--tree {}: expected two sensors, as ins0-ins1", item);
    links.push_back({item.substr(0, at), item.substr(at + 1)});
  }
  return links;
}

/// Options of the engines and those that use them.
struct EngineOption {
  const char* name;
  std::vector<std::string> engines;
};

const std::vector<EngineOption>& engine_options() {
  static const std::vector<EngineOption> options{
      {"--individuals", {"bmp", "bp"}}, {"--generations", {"bmp", "bp"}}, {"--clones", {"bmp", "bp"}},
      {"--cycles", {"bmp", "bp"}},      {"--transfers", {"bmp", "bp"}},   {"--pairing", {"bmp", "bp"}},
      {"--min-depth", {"bp"}},          {"--max-depth", {"bp"}},          {"--max-leaves", {"bp"}}};
  return options;
}

/// Euler terminals need paper 1's engine, so they choose it.
Result<std::string> engine_of(const CLI::App& verb, const EngineArguments& search) {
  if (search.terminals != "euler") return search.engine;
  if (was_given(verb, "--engine") && search.engine != "bp")
    return error("--terminals euler has no effect with --engine {}: only bp searches with Euler angles", search.engine);
  return "bp";
}

Result<void> check_engine_options(const CLI::App& verb, const std::string& engine) {
  std::vector<std::string> ineffective;
  for (const EngineOption& option : engine_options())
    if (was_given(verb, option.name) && std::ranges::find(option.engines, engine) == option.engines.end())
      ineffective.emplace_back(option.name);
  if (!ineffective.empty()) return error("{}: no effect with --engine {}", fmt::join(ineffective, ", "), engine);
  return {};
}

void set_evolution(BacterialOptions& bacteria, const EngineArguments& search) {
  bacteria.individuals = search.individuals.value_or(bacteria.individuals);
  bacteria.generations = search.generations.value_or(bacteria.generations);
  bacteria.clones = search.clones.value_or(bacteria.clones);
  bacteria.cycles = search.cycles.value_or(bacteria.cycles);
  bacteria.transfers = search.transfers.value_or(bacteria.transfers);
  bacteria.pairing = search.pairing == "mirrored" ? Pairing::mirrored : Pairing::halves;
}

identify::LinkEngine make_engine(const std::string& engine, const EngineArguments& search) {
  if (engine == "enum") {
    identify::Enumeration enumeration;
    enumeration.rows = search.rows.value_or(enumeration.rows);
    return enumeration;
  }
  if (engine == "bmp") {
    identify::MemeticProgramming memetic;
    set_evolution(memetic.bacteria, search);
    memetic.rows = search.rows.value_or(memetic.rows);
    return memetic;
  }
  identify::BacterialProgramming bacterial;
  set_evolution(bacterial.bacteria, search);
  bacterial.terminals = search.terminals == "euler" ? JointVariableKind::euler : JointVariableKind::hinge;
  bacterial.depth.min = search.min_depth.value_or(bacterial.depth.min);
  bacterial.depth.max = search.max_depth.value_or(bacterial.depth.max);
  bacterial.depth.max_leaves = search.max_leaves.value_or(bacterial.depth.max_leaves);
  bacterial.rows = search.rows.value_or(bacterial.rows);
  return bacterial;
}

Result<identify::LinkEngine> engine_from(const CLI::App& verb, const EngineArguments& search) {
  KINFER_TRY(engine, engine_of(verb, search));
  if (const auto checked = check_engine_options(verb, engine); !checked) return forward_error(checked.error());
  return make_engine(engine, search);
}

/// Nothing is searched in an update.
Result<void> check_update_options(const CLI::App& verb) {
  std::vector<std::string> ineffective;
  for (const char* name : {"--engine", "--terminals", "--rows"})
    if (was_given(verb, name)) ineffective.emplace_back(name);
  for (const EngineOption& option : engine_options())
    if (was_given(verb, option.name)) ineffective.emplace_back(option.name);
  if (ineffective.empty()) return {};
  return error("{}: no effect with --update, which searches nothing", fmt::join(ineffective, ", "));
}

Result<identify::IdentifyOptions> identify_options(const CLI::App& verb, const IdentifyArguments& options) {
  identify::IdentifyOptions how;
  const auto filter = filter_named(options.filter);
  if (!filter) return error("--filter {}: no such filter; known are {}", options.filter, filter_names());
  KINFER_TRY(engine, engine_from(verb, options.search));
  how.engine = engine;
  how.motion.filter = *filter;
  how.motion.smoothing = options.smoothing;
  if (!options.root.empty()) how.root = options.root;
  how.sensors = split_at_commas(options.sensors);
  KINFER_TRY(links, parse_links(options.tree));
  how.tree = links;
  KINFER_TRY(zeros, parse_zeros(options.zero));
  how.refine.zeros = zeros;
  how.links = options.links;
  how.geometry =
      options.geometry == "searched" ? identify::GeometrySource::searched : identify::GeometrySource::refined;
  if (options.grade != "auto") {
    KINFER_TRY(grade, read_grade(options.grade, "auto"));
    how.refine.grade = grade;
  }
  if (!options.facts.empty()) {
    KINFER_TRY(facts, read_machine_facts(options.facts));
    how.refine.facts = facts;
  }
  if (!options.update.empty()) {
    if (auto checked = check_update_options(verb); !checked) return forward_error(checked.error());
    KINFER_TRY(chain, read_tracked_chain(options.update, ""));
    how.refine.known = std::move(chain.model);
  }
  how.threads = options.common.threads;
  if (const auto checked = identify::check(how); !checked) return forward_error(checked.error());
  return how;
}

Provenance provenance_of(const IdentifyArguments& options, const InsRecording& recording,
                         const identify::IdentifyOptions& how, std::vector<InputFile> earlier) {
  std::vector<std::string> inputs = options.logs;
  if (!options.facts.empty()) inputs.push_back(options.facts);
  if (!options.columns.empty()) inputs.push_back(options.columns);
  if (!options.update.empty()) std::ranges::copy(ChainFiles(options.update).names(), std::back_inserter(inputs));
  auto described = identify::describe(how);
  if (!options.update.empty()) described.emplace_back("--update", options.update);
  return {.inputs = with_samples(fingerprints(inputs), recording),
          .options = std::move(described),
          .seed = options.common.seed,
          .earlier_inputs = std::move(earlier)};
}

Result<void> write_results(OutputFolder& folder, const Provenance& provenance, const Identification& found) {
  for (const OutputFile& file : identification_files(found))
    if (auto done = write_text_file(folder / file.name, file.text); !done) return done;
  return write_evidence(folder, identification_evidence(found, provenance));
}

ExpectedCost cost_of(const InsRecording& recording) {
  std::size_t rows = 0;
  for (const InsSensor& sensor : recording.sensors) rows += sensor.rows();
  const auto sensors = static_cast<double>(std::max<std::size_t>(1, recording.sensors.size()));
  return cost_of_identification(static_cast<double>(rows) / sensors, sensors);
}

int run(const CLI::App& verb, const IdentifyArguments& options) {
  RunRecord record("identify", options.common);
  for (const std::string& path : options.logs) record.add_input(path);
  if (!options.facts.empty()) record.add_input(options.facts);
  if (!options.columns.empty()) record.add_input(options.columns);
  if (!options.update.empty())
    for (const std::string& path : ChainFiles(options.update).names()) record.add_input(path);
  const auto how = identify_options(verb, options);
  if (!how) return fail(how.error());
  const auto recording = read_ins_logs({options.logs, options.columns, options.topics}, options.common);
  if (!recording) return fail(recording.error());
  const auto earlier = options.update.empty() ? std::vector<InputFile>{} : recordings_of_chain(options.update);
  if (auto fresh = expect_new_recordings(options.logs, *recording, earlier, options.update); !fresh)
    return fail(fresh.error());
  if (auto possible = check_cost(cost_of(*recording)); !possible) return fail(possible.error());
  auto folder = record.open_folder(options.out);
  if (!folder) return fail(folder.error());
  const Result<Identification> found = [&] {
    ProgressLine progress(options.common);
    return identify::identify_machine(*recording, *how, Rng(options.common.seed), progress.observer());
  }();
  if (!found) return fail(found.error());
  if (auto done = write_results(*folder, provenance_of(options, *recording, *how, earlier), *found); !done)
    return fail(done.error());
  if (auto done = record.write(*folder); !done) return fail(done.error());
  if (auto done = write_task_summary(*found); !done) return fail(done.error());
  if (auto done = folder->commit(); !done) return fail(done.error());
  if (options.common.json)
    print_data(format_identification_headline(*found));
  else if (!options.common.quiet)
    print_summary(identification_summary(*found), tone_of(found->usability));
  return found->usability == Usability::do_not_use ? exit_do_not_use : exit_done;
}

void add_engine_options(CLI::App& verb, EngineArguments& search) {
  constexpr int most = 1000000;
  begin_group(verb, "Search engine");
  add_choice(verb, "--engine", search.engine, {"bmp", "bp", "enum"},
             "How each link is searched; bmp: memetic bacterial programming; bp: that of paper 1; enum: every chain of "
             "up to 3 leaves");
  add_choice(verb, "--terminals", search.terminals, {"hinge", "euler"},
             "hinge: relative rotations, rates from gyros; euler: differences of Euler angles, as in paper 1 (bp)");
  add_count(verb, "--individuals", search.individuals, 2, most, "Bacteria in the population (bmp 10; bp 100: paper 1)");
  add_count(verb, "--generations", search.generations, 0, most, "Generations a link (bmp 30; bp 300: paper 1)");
  add_count(verb, "--clones", search.clones, 1, most,
            "Clones of a bacterium in its mutation, itself included (bmp 3, bp 5)");
  add_count(verb, "--cycles", search.cycles, 0, most,
            "Parts of a bacterium that are mutated in a generation (bmp 1, bp 3)");
  add_count(verb, "--transfers", search.transfers, 0, most, "Genes transferred in a generation (bmp 3, bp 20)");
  add_choice(verb, "--pairing", search.pairing, {"halves", "mirrored"},
             "Gene transfer: one from each half, or best with worst (pseudo code)");
  add_count(verb, "--min-depth", search.min_depth, 1, 20, "Least depth of a tree (bp only; 1)");
  add_count(verb, "--max-depth", search.max_depth, 1, 20, "Largest depth of a tree (bp only; 5)");
  add_count(verb, "--max-leaves", search.max_leaves, 1, 1000, "Most leaves of a tree (bp only; 8)");
  add_count(verb, "--rows", search.rows, 20, most, "Rows of the log that the cost sums over (384)");
}

}  // namespace

Verb add_identify(CLI::App& app) {
  CLI::App* verb =
      add_command(app, "identify", "Find the chain of an unknown machine from one INS on each segment",
                  "Let the machine rest for a few seconds, move joint after joint, then all together.\nExample:\n"
                  "  kinfer simulate excavator --out drive --grade noise\n"
                  "  kinfer identify drive/imu.csv --out excavator\n"
                  "What changed since, after a knock or a repair:\n"
                  "  kinfer identify --update excavator drive/imu.csv --out excavator-new");
  auto options = std::make_shared<IdentifyArguments>();
  add_texts(*verb, "logs", options->logs, "INS recordings", Requirement::required, "CSV");
  add_text(*verb, "--out", options->out,
           "Folder for chain.toml, track.toml, chain.urdf, chain.mjcf, chain_dh.csv, evidence.json, report.html, "
           "run.json",
           Requirement::required, "DIR");
  begin_group(*verb, "Recording");
  add_text(*verb, "--filter", options->filter, "Orientation filter. " + filter_help(), Requirement::optional, "NAME");
  add_text(*verb, "--root", options->root, "Sensor on the machine's base (default: the one that stands still)",
           Requirement::optional, "NAME");
  add_text(*verb, "--sensors", options->sensors, "Only these sensors of the log, as ins0,ins1,ins2",
           Requirement::optional, "NAMES");
  add_text(*verb, "--tree", options->tree,
           "Which sensors' segments share joints, as ins0-ins1,ins1-ins2 (default: as the log tells; what it tells "
           "against them is said)",
           Requirement::optional, "LINKS");
  add_number(*verb, "--smoothing", options->smoothing, 0.0, 10.0,
             "Standard deviation of the Gaussian on accelerations and rates [s]");
  begin_group(*verb, "Estimation");
  add_choice(*verb, "--geometry", options->geometry, {"refined", "searched"},
             "refined: continuous-time fit of the whole recording; searched: as the search found it (paper 1)");
  add_text(*verb, "--grade", options->grade, "What the sensors are worth: auto, noise, industrial, consumer or a TOML",
           Requirement::optional, "GRADE");
  add_text(*verb, "--facts", options->facts,
           "What else is known: touches, tapes, surveyed points (docs/formats.md, Facts about a machine)",
           Requirement::optional, "TOML");
  add_text(
      *verb, "--zero", options->zero,
      "Zeros of joint positions, as swing=0deg@12.5s,mast=250mm@3s: the joint that moves the sensor swing was at 0° "
      "12.5 s into the log (default: 0 where the log begins)",
      Requirement::optional, "JOINTS");
  add_text(
      *verb, "--update", options->update,
      "Folder of an earlier identification of this machine: its structure is kept, what changed since is said, and "
      "the new chain is that of both logs",
      Requirement::optional, "CHAIN");
  add_count(*verb, "--links", options->links, 0, 1000, "Links to find, from the root outwards; 0 means all");
  add_log_options(*verb, options->columns, options->topics);
  add_engine_options(*verb, options->search);
  add_common_options(*verb, options->common);
  return {verb, [verb, options] { return run(*verb, *options); }};
}

}  // namespace kinfer::cli
