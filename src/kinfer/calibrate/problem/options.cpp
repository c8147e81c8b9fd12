// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/problem/options.hpp"

#include <fmt/ranges.h>

#include <sstream>

namespace kinfer::calibrate {
namespace {

using Described = std::vector<std::pair<std::string, std::string>>;

std::string number(double value) {
  return fmt::format("{:g}", value);
}

std::string describe_parameters(const ParameterChoice& choice) {
  if (std::holds_alternative<PaperDhParameters>(choice)) return "paper24";
  if (const auto* named = std::get_if<NamedParameters>(&choice)) return fmt::format("{}", fmt::join(named->names, " "));
  return "auto";
}

std::string describe_model(const CalibrationOptions& options) {
  if (!allows_model_terms(options)) return "geometry";
  const auto* fixed = std::get_if<FixedModel>(&options.model);
  if (!fixed) return "auto";
  std::string text;
  for (const Term term : fixed->terms) text += (text.empty() ? "" : "+") + std::string(name(term));
  return text.empty() ? "geometry" : text;
}

void describe_pso(const PsoOptions& pso, Described& list) {
  constexpr std::string_view walls[] = {"absorb", "clamp", "open"};  // in the order of BoundaryHandling
  list.emplace_back("--inertia", number(pso.inertia));
  list.emplace_back("--own", number(pso.cognitive));
  list.emplace_back("--swarm", number(pso.social));
  list.emplace_back("--walls", walls[static_cast<std::size_t>(pso.boundary)]);
}

void describe_swarm(const SwarmSearchOptions& options, Described& list) {
  const Budget& limits = budget(options.search);
  list.emplace_back("--method", name(method(options.search)));
  list.emplace_back("--particles", std::to_string(particles(options.search)));
  list.emplace_back("--iterations", std::to_string(limits.max_iterations));
  if (const auto* pso = std::get_if<PsoOptions>(&options.search)) describe_pso(*pso, list);
  if (const auto* bpnn = std::get_if<BpnnPsoOptions>(&options.search)) {
    describe_pso(bpnn->pso, list);
    list.emplace_back("--net-use", bpnn->use == NetUse::initial_swarm ? "initial-swarm" : "every-update");
  }
  if (const auto* box = std::get_if<ToleranceBox>(&options.box)) {
    list.emplace_back("--box-tolerances", number(box->tolerances));
  } else {
    const auto& [length, angle] = std::get<AbsoluteBox>(options.box);
    list.emplace_back("--box-length", number(length / 1e-3));
    list.emplace_back("--box-angle", number(angle / degree));
  }
}

/// "6R", "2RP3R"
std::string describe_joint_types(const std::vector<JointType>& types) {
  std::string text;
  for (std::size_t i = 0; i < types.size();) {
    std::size_t end = i;
    while (end < types.size() && types[end] == types[i]) ++end;
    text += (end - i > 1 ? std::to_string(end - i) : "") + (rotates(types[i]) ? "R" : "P");
    i = end;
  }
  return text;
}

}  // namespace

Result<ModelChoice> parse_model_choice(const std::string& text) {
  if (text == "auto") return AutomaticModel{};
  FixedModel model;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, '+');) {
    if (word == "geometry") continue;
    const auto term = term_named(word);
    if (!term)
      return error("--model {}: expected auto, geometry or some of {} joined by +", text,
                   fmt::join(term_names(), ", "));
    model.terms.push_back(*term);
  }
  return model;
}

bool allows_model_terms(const CalibrationOptions& options) {
  return std::holds_alternative<GeometricParameters>(options.parameters) && !options.swarm_search;
}

Result<void> check_options(const CalibrationTask& task, const CalibrationOptions& options) {
  const auto* fixed = std::get_if<FixedModel>(&options.model);
  if (fixed && !fixed->terms.empty() && !allows_model_terms(options))
    return error("model terms need the complete geometric set and a least-squares fit");
  if (options.swarm_search && task.has_population() && !(task.instrument && task.instrument->states_lengths()))
    return error(
        "a swarm search weighs the prior of earlier calibrations by the instrument's noise: expected [instrument] "
        "sigma "
        "in the robot file");
  return {};
}

std::vector<std::pair<std::string, std::string>> describe(const CalibrationTask& task,
                                                          const CalibrationOptions& options) {
  Described list;
  if (!task.joint_types.empty()) list.emplace_back("--robot", "unknown:" + describe_joint_types(task.joint_types));
  if (std::holds_alternative<JointOffsetParameters>(options.parameters)) {
    list.emplace_back("--refit", "offsets");
  } else {
    list.emplace_back("--parameters", describe_parameters(options.parameters));
    list.emplace_back("--model", describe_model(options));
  }
  if (options.swarm_search) describe_swarm(*options.swarm_search, list);
  if (const auto* part = std::get_if<HeldOutFraction>(&options.holdout))
    list.emplace_back("--holdout", number(part->fraction));
  return list;
}

}  // namespace kinfer::calibrate
