// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/options/search_options.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "kinfer/calibrate/starting_model.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/fleet/fleet_json.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"

namespace kinfer::cli {
namespace {

std::filesystem::path net_path(const SearchArguments& arguments) {
  return std::filesystem::path(arguments.warm_start) / "net.txt";
}

std::string chain_path(const SearchArguments& arguments) {
  return (std::filesystem::path(arguments.warm_start) / "chain.toml").string();
}

bool has_net(const SearchArguments& arguments) {
  return !arguments.warm_start.empty() && std::filesystem::is_regular_file(net_path(arguments));
}

PsoOptions pso_options(const SearchArguments& a) {
  PsoOptions pso{.inertia = a.inertia, .cognitive = a.own, .social = a.swarm};
  if (a.boundary == "clamp") pso.boundary = BoundaryHandling::clamp;
  if (a.boundary == "open") pso.boundary = BoundaryHandling::open;
  return pso;
}

Result<BpnnPsoOptions> bpnn_options(const SearchArguments& arguments) {
  BpnnPsoOptions bpnn{.pso = pso_options(arguments)};
  if (arguments.net_use == "every-update") bpnn.use = NetUse::before_every_update;
  if (!has_net(arguments)) return bpnn;
  KINFER_TRY(text, read_text_file(net_path(arguments)));
  KINFER_TRY(net, parse_mlp(text, net_path(arguments).string()));
  bpnn.net = std::move(net);
  return bpnn;
}

Result<Chain> read_earlier_chain(const std::string& path, const calibrate::CalibrationTask& task) {
  KINFER_TRY(robot, read_robot_toml(path));
  if (task.joint_types.empty())
    if (auto same = calibrate::check_same_joints(robot.chain, task.nominal); !same)
      return error("{}: {}", path, same.error().what);
  return robot.chain;
}

/// The folder of a merge, or its prior.json; else the chain.toml of an earlier calibration.
bool is_population(const std::string& path) {
  return path.ends_with(".json") || std::filesystem::is_directory(path);
}

std::string population_path(const std::string& path) {
  return path.ends_with(".json") ? path : (std::filesystem::path(path) / "prior.json").string();
}

bool names_joint_parameters_of(const calibrate::CalibrationTask& task, const PopulationPrior& population) {
  const ParameterSet set = all_parameters(task.nominal, task.tolerances);
  return std::ranges::any_of(population.names, [&](const std::string& name) { return set.find(name) != nullptr; });
}

/// The methods in which an option has an effect.
struct SwarmOption {
  const char* name;
  std::vector<std::string> methods;
};

const std::vector<SwarmOption>& swarm_only_options() {
  static const std::vector<std::string> any{"pso", "qpso", "bpnn-pso"}, particle_swarm{"pso", "bpnn-pso"};
  static const std::vector<SwarmOption> list{{"--particles", any},        {"--iterations", any},
                                             {"--box-length", any},       {"--box-angle", any},
                                             {"--box-tolerances", any},   {"--inertia", particle_swarm},
                                             {"--own", particle_swarm},   {"--swarm", particle_swarm},
                                             {"--walls", particle_swarm}, {"--net-use", {"bpnn-pso"}}};
  return list;
}

}  // namespace

void add_search_arguments(CLI::App& verb, SearchArguments& a) {
  std::vector<std::string> methods{"lm"};
  for (const SwarmMethod& method : swarm_methods()) methods.emplace_back(method.name);
  add_choice(verb, "--method", a.method, methods, "lm: least squares; the others are swarm searches (paper 2)");
  add_text(verb, "--warm-start", a.warm_start, "Folder of an earlier calibration of this robot: where searches start",
           Requirement::optional, "DIR");
  add_texts(
      verb, "--prior", a.prior,
      "Robots of this kind, whose mean and spread are the prior: chain.toml files of earlier calibrations, or the "
      "folder that `kinfer merge` made",
      Requirement::optional, "TOML");
  add_count(verb, "--particles", a.particles, 2, 100000, "Swarm search: number of particles");
  add_count(verb, "--iterations", a.iterations, 1, 10000000,
            "Swarm search: largest number of updates; it ends earlier where 200 updates gain less than 1 %");
  add_number(verb, "--inertia", a.inertia, 0.0, 10.0,
             "PSO: weight w of the velocity (paper: 0.9, which hardly converges)");
  add_number(verb, "--own", a.own, 0.0, 10.0, "PSO: c1, pull of a particle's own best");
  add_number(verb, "--swarm", a.swarm, 0.0, 10.0, "PSO: c2, pull of the swarm's best");
  add_choice(verb, "--walls", a.boundary, {"absorb", "clamp", "open"}, "PSO: particles that leave the box");
  add_choice(verb, "--net-use", a.net_use, {"initial-swarm", "every-update"},
             "BPNN-PSO: every-update is the literal reading, and harms");
  add_number(verb, "--box-length", a.box_length, 0.0, 1e5, "Half width of the box about the nominal lengths [mm]");
  add_number(verb, "--box-angle", a.box_angle, 0.0, 180.0, "Half width of the box about the nominal angles [deg]");
  add_number(verb, "--box-tolerances", a.box_tolerances, 0.0, 1e6,
             "Half width of the box in tolerances instead (0: not)");
}

Result<void> check_search_arguments(const SearchArguments& arguments, const CLI::App& verb) {
  for (const auto& [name, methods] : swarm_only_options())
    if (was_given(verb, name) && std::ranges::find(methods, arguments.method) == methods.end())
      return error("{} has no effect with --method {}; it belongs to {}", name, arguments.method,
                   fmt::join(methods, ", "));
  for (const char* absolute : {"--box-length", "--box-angle"})
    if (was_given(verb, absolute) && was_given(verb, "--box-tolerances"))
      return error("{} has no effect with --box-tolerances: the box is given in tolerances", absolute);
  return {};
}

Result<std::optional<calibrate::SwarmSearchOptions>> read_swarm_options(const SearchArguments& arguments) {
  if (arguments.method == "lm") return std::nullopt;
  const Budget budget{.max_iterations = arguments.iterations, .patience = calibrate::swarm_patience};
  calibrate::SwarmSearchOptions options;
  if (arguments.box_tolerances > 0.0)
    options.box = calibrate::ToleranceBox{arguments.box_tolerances};
  else if (arguments.box_length > 0.0 && arguments.box_angle > 0.0)
    options.box = calibrate::AbsoluteBox{1e-3 * arguments.box_length, arguments.box_angle * degree};
  else
    return error("--box-length and --box-angle must be above 0");
  const SwarmMethod& method = *method_named(arguments.method);
  options.search = method.default_options;
  if (std::holds_alternative<PsoOptions>(options.search)) options.search = pso_options(arguments);
  if (std::holds_alternative<BpnnPsoOptions>(options.search)) {
    KINFER_TRY(bpnn, bpnn_options(arguments));
    options.search = std::move(bpnn);
  }
  method.budget(options.search) = budget;
  method.particles(options.search) = arguments.particles;
  return options;
}

Result<void> read_earlier_calibrations(const SearchArguments& arguments, calibrate::CalibrationTask& task) {
  for (const std::string& path : arguments.prior) {
    if (is_population(path)) {
      if (arguments.prior.size() > 1) return error("--prior: expected one fleet, or chain.toml files");
      KINFER_TRY(population, read_population(population_path(path)));
      if (!names_joint_parameters_of(task, population))
        return error("{}: none of its parameters is one of this robot's", population_path(path));
      task.population = std::move(population);
      continue;
    }
    KINFER_TRY(chain, read_earlier_chain(path, task));
    task.robot_population.push_back(std::move(chain));
  }
  if (arguments.warm_start.empty()) return {};
  KINFER_TRY(chain, read_earlier_chain(chain_path(arguments), task));
  task.earlier = std::move(chain);
  return {};
}

Result<void> check_prior(const std::string& path) {
  if (!std::filesystem::exists(path)) return error("--prior: {}: no such file or folder", path);
  if (!is_population(path)) return {};
  KINFER_TRY(population, read_population(population_path(path)));
  return {};
}

std::vector<std::string> input_paths(const SearchArguments& arguments) {
  std::vector<std::string> paths;
  for (const std::string& path : arguments.prior) paths.push_back(is_population(path) ? population_path(path) : path);
  if (!arguments.warm_start.empty()) paths.push_back(chain_path(arguments));
  if (has_net(arguments) && arguments.method == "bpnn-pso") paths.push_back(net_path(arguments).string());
  return paths;
}

}  // namespace kinfer::cli
