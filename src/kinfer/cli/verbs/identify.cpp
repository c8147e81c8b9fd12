// SPDX-License-Identifier: Apache-2.0
// kinfer identify: INS logs of an unknown machine -> order of its segments, chain, evidence.
#include "kinfer/identify/pipeline.hpp"

#include <fmt/ranges.h>

#include <map>
#include <memory>

#include "kinfer/cli/parts/arguments.hpp"
#include "kinfer/cli/parts/drive_choices.hpp"
#include "kinfer/cli/parts/evidence_files.hpp"
#include "kinfer/cli/parts/identification_summary.hpp"
#include "kinfer/cli/parts/ins_logs.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/identify/findings/forecast.hpp"
#include "kinfer/io/evidence/chain_dh_csv.hpp"
#include "kinfer/io/evidence/identification_json.hpp"
#include "kinfer/io/recording/machine_facts_toml.hpp"
#include "kinfer/io/robot/mjcf.hpp"
#include "kinfer/io/robot/robot_toml.hpp"
#include "kinfer/io/robot/urdf.hpp"
#include "kinfer/io/text/text_file.hpp"

namespace kinfer::cli {
namespace {

struct IdentifyArguments {
  CommonOptions common;
  std::vector<std::string> logs;
  std::string out, engine = "bmp", terminals = "hinge", filter = "kinfer-offline", root, pairing = "halves";
  double smoothing = SegmentMotionOptions{}.smoothing;
  identify::BacterialLinkOptions search;
  int links = 0;
  std::string geometry = "refined", grade = "auto", facts, sensors, tree;
};

const std::map<std::string, identify::Engine> engines{
    {"bmp", identify::Engine::bmp}, {"bp", identify::Engine::bp}, {"enum", identify::Engine::enumeration}};
const std::map<std::string, JointVariableKind> terminals_by_name{{"hinge", JointVariableKind::hinge},
                                                                 {"euler", JointVariableKind::euler}};
const std::map<std::string, identify::GeometrySource> geometries{{"refined", identify::GeometrySource::refined},
                                                                 {"searched", identify::GeometrySource::searched}};
const std::map<std::string, Pairing> pairings{{"halves", Pairing::halves}, {"mirrored", Pairing::mirrored}};

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

Result<identify::IdentifyOptions> identify_options(const IdentifyArguments& options) {
  identify::IdentifyOptions how;
  const auto filter = filter_named(options.filter);
  if (!filter) return error("--filter {}: no such filter; known are {}", options.filter, filter_names());
  if (options.search.depth.max < options.search.depth.min)
    return error("--max-depth {}: less than --min-depth {}", options.search.depth.max, options.search.depth.min);
  if (options.search.depth.max_leaves < options.search.depth.min)
    return error("--max-leaves {}: too few for --min-depth {}", options.search.depth.max_leaves,
                 options.search.depth.min);
  if (!(options.smoothing >= 0.0 && options.smoothing <= 1.0))
    return error("--smoothing {}: expected 0 .. 1 s", options.smoothing);
  how.motion.filter = *filter;
  how.motion.smoothing = options.smoothing;
  how.engine = engines.at(options.engine);
  how.terminals = terminals_by_name.at(options.terminals);
  how.search = options.search;
  how.search.bacteria.pairing = pairings.at(options.pairing);
  if (!options.root.empty()) how.root = options.root;
  how.sensors = split_at_commas(options.sensors);
  KINFER_TRY(links, parse_links(options.tree));
  how.tree = links;
  how.links = options.links;
  how.geometry = geometries.at(options.geometry);
  if (options.grade != "auto") {
    KINFER_TRY(grade, read_grade(options.grade, "auto"));
    how.refine.grade = grade;
  }
  if (!options.facts.empty()) {
    KINFER_TRY(facts, read_machine_facts(options.facts));
    how.refine.facts = facts;
  }
  how.threads = options.common.threads;
  return how;
}

Provenance provenance_of(const IdentifyArguments& options) {
  Provenance provenance;
  provenance.seed = options.common.seed;
  std::vector<std::string> inputs = options.logs;
  if (!options.facts.empty()) inputs.push_back(options.facts);
  provenance.inputs = fingerprints(inputs);
  const BacterialOptions& b = options.search.bacteria;
  provenance.options = {{"--engine", options.engine},
                        {"--terminals", options.terminals},
                        {"--filter", options.filter},
                        {"--root", options.root},
                        {"--smoothing", fmt::to_string(options.smoothing)},
                        {"--individuals", fmt::to_string(b.individuals)},
                        {"--generations", fmt::to_string(b.generations)},
                        {"--clones", fmt::to_string(b.clones)},
                        {"--cycles", fmt::to_string(b.cycles)},
                        {"--transfers", fmt::to_string(b.transfers)},
                        {"--pairing", options.pairing},
                        {"--min-depth", fmt::to_string(options.search.depth.min)},
                        {"--max-depth", fmt::to_string(options.search.depth.max)},
                        {"--max-leaves", fmt::to_string(options.search.depth.max_leaves)},
                        {"--rows", fmt::to_string(options.search.rows)},
                        {"--links", fmt::to_string(options.links)},
                        {"--sensors", options.sensors},
                        {"--tree", options.tree},
                        {"--geometry", options.geometry},
                        {"--grade", options.grade}};
  return provenance;
}

Result<void> write_results(const OutputFolder& folder, const IdentifyArguments& options, const Identification& found) {
  RobotModel robot{.chain = found.chain};
  if (auto done = write_text_file(folder / "chain.toml", format_robot_toml(robot)); !done) return done;
  if (auto done = write_text_file(folder / "chain.urdf", format_urdf(found.chain)); !done) return done;
  if (auto done = write_text_file(folder / "chain.mjcf", format_mjcf(found.chain)); !done) return done;
  if (auto done = write_text_file(folder / "chain_dh.csv", format_chain_dh_csv(found.dh)); !done) return done;
  return write_evidence(folder.path(), format_identification_evidence(found, provenance_of(options)));
}

int run(const IdentifyArguments& options) {
  RunRecord record("identify", options.common);
  for (const std::string& path : options.logs) record.add_input(path);
  if (!options.facts.empty()) record.add_input(options.facts);
  const auto how = identify_options(options);
  if (!how) return fail(how.error());
  const auto recording = read_ins_logs(options.logs);
  if (!recording) return fail(recording.error());
  const auto folder = OutputFolder::make(options.out);
  if (!folder) return fail(folder.error());
  const Result<Identification> found = [&] {
    ProgressLine progress(options.common);
    return identify::identify_machine(*recording, *how, Rng(options.common.seed), progress.observer());
  }();
  if (!found) return fail(found.error());
  if (auto done = write_results(*folder, options, *found); !done) return fail(done.error());
  if (auto done = record.write(options.out); !done) return fail(done.error());
  if (options.common.json)
    fmt::print("{}", format_identification_headline(*found));
  else if (!options.common.quiet)
    print_summary(identification_summary(*found),
                  found->use ? identify::all_sufficient(found->forecast) ? Tone::good : Tone::neutral : Tone::bad);
  return found->use ? exit_done : exit_do_not_use;
}

void add_search_options(CLI::App& verb, IdentifyArguments& options) {
  BacterialOptions& b = options.search.bacteria;
  DepthLimits& depth = options.search.depth;
  constexpr int most = 1000000;
  add_count(verb, "--individuals", b.individuals, 2, most, "Bacteria in the population (paper 1, table 4)");
  add_count(verb, "--generations", b.generations, 0, most, "Generations a link");
  add_count(verb, "--clones", b.clones, 1, most, "Clones of a bacterium in its mutation, itself included");
  add_count(verb, "--cycles", b.cycles, 0, most, "Parts of a bacterium that are mutated in a generation");
  add_count(verb, "--transfers", b.transfers, 0, most, "Genes transferred in a generation");
  add_choice(verb, "--pairing", options.pairing, {"halves", "mirrored"},
             "Gene transfer: one from each half, or best with worst (pseudo code)");
  add_count(verb, "--min-depth", depth.min, 1, 20, "Least depth of a tree");
  add_count(verb, "--max-depth", depth.max, 1, 20, "Largest depth of a tree");
  add_count(verb, "--max-leaves", depth.max_leaves, 1, 1000, "Most leaves of a tree");
  add_count(verb, "--rows", options.search.rows, 20, most, "Rows of the log that the cost sums over");
}

}  // namespace

Verb add_identify(CLI::App& app) {
  CLI::App* verb =
      add_command(app, "identify", "Find the chain of an unknown machine from one INS on each segment",
                  "Let the machine rest for a few seconds, move joint after joint, then all together.\nExample:\n"
                  "  kinfer simulate excavator --out drive --grade noise\n"
                  "  kinfer identify drive/imu.csv --out excavator");
  auto options = std::make_shared<IdentifyArguments>();
  add_texts(*verb, "logs", options->logs, "INS recordings", Requirement::required, "CSV");
  add_text(*verb, "--out", options->out,
           "Folder for chain.toml, chain.urdf, chain.mjcf, chain_dh.csv, evidence.json, report.html, run.json",
           Requirement::required, "DIR");
  add_choice(*verb, "--engine", options->engine, {"bmp", "bp", "enum"},
             "How each link is searched; bmp: memetic bacterial programming; bp: that of paper 1; enum: every chain of "
             "up to 3 leaves");
  add_choice(*verb, "--terminals", options->terminals, {"hinge", "euler"},
             "hinge: relative rotations, rates from gyros; euler: differences of Euler angles, as in paper 1");
  add_text(*verb, "--filter", options->filter, "Orientation filter. " + filter_help(), Requirement::optional, "NAME");
  add_text(*verb, "--root", options->root, "Sensor on the machine's base (default: the one that stands still)",
           Requirement::optional, "NAME");
  add_text(*verb, "--sensors", options->sensors, "Only these sensors of the log, as ins0,ins1,ins2",
           Requirement::optional, "NAMES");
  add_text(*verb, "--tree", options->tree,
           "Which sensors' segments share joints, as ins0-ins1,ins1-ins2 (default: as the log tells; what it tells "
           "against them is said)",
           Requirement::optional, "LINKS");
  add_number(*verb, "--smoothing", options->smoothing,
             "Standard deviation of the Gaussian on accelerations and rates [s]");
  add_choice(*verb, "--geometry", options->geometry, {"refined", "searched"},
             "refined: continuous-time fit of the whole recording; searched: as the search found it (paper 1)");
  add_text(*verb, "--grade", options->grade, "What the sensors are worth: auto, noise, industrial, consumer or a TOML",
           Requirement::optional, "GRADE");
  add_text(*verb, "--facts", options->facts,
           "What else is known: touches, tapes, surveyed points (docs/formats.md, Facts about a machine)",
           Requirement::optional, "TOML");
  add_count(*verb, "--links", options->links, 0, 1000, "Links to find, from the root outwards; 0 means all");
  add_search_options(*verb, *options);
  add_common_options(*verb, options->common);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
