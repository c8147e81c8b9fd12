// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/options.hpp"

#include <fmt/ranges.h>

#include <array>

#include "kinfer/base/overloaded.hpp"

namespace kinfer::identify {
namespace {

using NamedValues = std::vector<std::pair<std::string, std::string>>;

Result<void> check_depth(const DepthLimits& depth) {
  if (depth.max < depth.min) return error("--max-depth {}: less than --min-depth {}", depth.max, depth.min);
  if (depth.max_leaves < depth.min)
    return error("--max-leaves {}: too few for --min-depth {}", depth.max_leaves, depth.min);
  return {};
}

/// What an update takes from the older chain is not an option.
Result<void> check_update(const IdentifyOptions& options) {
  const std::array<std::pair<const char*, bool>, 6> given{
      {{"--tree", !options.tree.empty()},
       {"--root", options.root.has_value()},
       {"--sensors", !options.sensors.empty()},
       {"--links", options.links > 0},
       {"--zero", !options.refine.zeros.empty()},
       {"--geometry searched", options.geometry == GeometrySource::searched}}};
  for (const auto& [name, is_given] : given)
    if (is_given) return error("{} has no effect with --update, which keeps that of the chain", name);
  return {};
}

void describe_evolution(NamedValues& list, const BacterialOptions& bacteria) {
  list.insert(list.end(), {{"--individuals", fmt::to_string(bacteria.individuals)},
                           {"--generations", fmt::to_string(bacteria.generations)},
                           {"--clones", fmt::to_string(bacteria.clones)},
                           {"--cycles", fmt::to_string(bacteria.cycles)},
                           {"--transfers", fmt::to_string(bacteria.transfers)},
                           {"--pairing", bacteria.pairing == Pairing::halves ? "halves" : "mirrored"}});
}

void describe_engine(NamedValues& list, const LinkEngine& engine) {
  std::visit(Overloaded{[&](const MemeticProgramming& memetic) { describe_evolution(list, memetic.bacteria); },
                        [&](const BacterialProgramming& bacterial) {
                          describe_evolution(list, bacterial.bacteria);
                          list.insert(list.end(), {{"--min-depth", fmt::to_string(bacterial.depth.min)},
                                                   {"--max-depth", fmt::to_string(bacterial.depth.max)},
                                                   {"--max-leaves", fmt::to_string(bacterial.depth.max_leaves)}});
                        },
                        [](const Enumeration&) {}},
             engine);
  list.emplace_back("--rows", fmt::to_string(std::visit([](const auto& one) { return one.rows; }, engine)));
}

/// "ins0-ins1,ins1-ins2"; a colon separates names that contain hyphens.
std::string links_text(const std::vector<GivenLink>& links) {
  std::vector<std::string> items;
  for (const GivenLink& link : links) {
    const bool has_hyphen = (link.first + link.second).find('-') != std::string::npos;
    items.push_back(link.first + (has_hyphen ? ":" : "-") + link.second);
  }
  return fmt::format("{}", fmt::join(items, ","));
}

}  // namespace

Result<void> check(const IdentifyOptions& options) {
  if (!(options.motion.smoothing >= 0.0 && options.motion.smoothing <= 1.0))
    return error("--smoothing {}: expected 0 .. 1 s", options.motion.smoothing);
  if (options.geometry == GeometrySource::searched && !options.refine.facts.empty())
    return error("--facts has no effect with --geometry searched");
  if (options.geometry == GeometrySource::searched && !options.refine.zeros.empty())
    return error("--zero has no effect with --geometry searched");
  if (options.geometry == GeometrySource::searched && options.refine.grade)
    return error("--grade has no effect with --geometry searched");
  if (options.refine.known)
    if (auto checked = check_update(options); !checked) return checked;
  if (const auto* bacterial = std::get_if<BacterialProgramming>(&options.engine)) return check_depth(bacterial->depth);
  return {};
}

NamedValues describe(const IdentifyOptions& options) {
  NamedValues list{{"--engine", std::string(name(method_of(options.engine)))},
                   {"--terminals", terminals_of(options.engine) == JointVariableKind::euler ? "euler" : "hinge"},
                   {"--filter", std::string(filter_of(options.motion.filter).name)},
                   {"--root", options.root.value_or("")},
                   {"--smoothing", fmt::to_string(options.motion.smoothing)}};
  describe_engine(list, options.engine);
  const bool is_refined = options.geometry == GeometrySource::refined;
  list.insert(list.end(), {{"--links", fmt::to_string(options.links)},
                           {"--sensors", fmt::format("{}", fmt::join(options.sensors, ","))},
                           {"--tree", links_text(options.tree)},
                           {"--geometry", is_refined ? "refined" : "searched"}});
  if (is_refined) list.emplace_back("--grade", options.refine.grade ? options.refine.grade->name : "auto");
  for (const NamedZero& zero : options.refine.zeros)
    list.emplace_back("--zero", fmt::format("{}={}{}@{}s", zero.joint, zero.position,
                                            zero.motion == elementary::Motion::rotation ? "rad" : "m", zero.at));
  return list;
}

}  // namespace kinfer::identify
