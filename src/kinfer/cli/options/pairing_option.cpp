// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/options/pairing_option.hpp"

namespace kinfer::cli {
namespace {

std::optional<PairingMethod> pairing_method_named(const std::string& text) {
  for (const PairingMethod method : {PairingMethod::name, PairingMethod::time, PairingMethod::order})
    if (name(method) == text) return method;
  return std::nullopt;
}

std::string lines_alone(const std::string& file, const PoseSet& set, const std::vector<Rest>& rests,
                        const std::vector<int>& alone) {
  std::string text;
  for (const int i : alone)
    text += fmt::format("  no partner: {} ({})\n", file, place_of_rest(set, rests[static_cast<std::size_t>(i)]));
  return text;
}

}  // namespace

void add_pairing_options(CLI::App& verb, PairingOption& option, Requirement need) {
  add_text(
      verb, "--joints", option.joints,
      "Joint positions: a stream with column t, a list, a log of UR RTDE, KUKA RSI or OpenSim, or a robot log with "
      "JointState",
      need, "FILE");
  add_text(verb, "--measured", option.measured,
           "Measured tool points: a stream with column t, a list, a tracker's file (Qualisys, Motive, .trc, "
           "SpatialAnalyzer), or a robot log with PoseStamped, PointStamped or TransformStamped",
           need, "FILE");
  add_text(verb, "--measured-columns", option.measured_columns, "How the tracker file's columns map to kinfer's",
           Requirement::optional, "TOML");
  add_text(verb, "--marker", option.marker, "Marker or rigid body of a tracker's file that is the tool point",
           Requirement::optional, "NAME");
  add_list(verb, "--topic", option.topics, "Topic of a robot log; may be repeated (default: the only one that fits)",
           "NAME");
  add_choice(verb, "--by", option.by, {"auto", "name", "time", "order"}, "What tells the partner of a rest");
  add_number(verb, "--offset", option.offset, option.has_offset, -1e10, 1e10,
             "By time: tracker's clock minus robot's, roughly [s]");
}

std::vector<std::pair<std::string, std::string>> given_pairing_options(const CLI::App& verb,
                                                                       const PairingOption& option) {
  std::vector<std::pair<std::string, std::string>> given;
  const auto add = [&](const char* name, const std::string& value) {
    if (was_given(verb, name)) given.emplace_back(name, value);
  };
  add("--measured-columns", std::filesystem::path(option.measured_columns).filename().string());
  add("--marker", option.marker);
  for (const std::string& topic : option.topics) given.emplace_back("--topic", topic);
  add("--by", option.by);
  add("--offset", fmt::format("{}", option.offset));
  return given;
}

Result<PairedFiles> read_paired(const PairingOption& option, const std::string& joint_columns, const Chain& chain,
                                bool has_model) {
  KINFER_TRY(joint_map, read_columns_option(joint_columns));
  KINFER_TRY(measured_map, read_columns_option(option.measured_columns));
  const PairedSources sources{
      .joints = option.joints,
      .measured = option.measured,
      .joint_choice = {.map = std::move(joint_map), .topics = option.topics},
      .measured_choice = {.map = std::move(measured_map), .marker = option.marker, .topics = option.topics}};
  return read_paired_files(sources, chain,
                           {.method = pairing_method_named(option.by),
                            .offset = option.has_offset ? std::optional(option.offset) : std::nullopt,
                            .has_model = has_model});
}

std::string pairing_summary(const PairingOption& option, const PairedFiles& paired) {
  const RestPairing& pairing = paired.pairing;
  std::string text;
  for (const auto& [file, log] :
       {std::pair(&option.joints, &paired.joints), std::pair(&option.measured, &paired.measured)}) {
    if (!log->format.empty()) text += fmt::format("{}: read as {}\n", *file, log->format);
    for (const std::string& remark : log->remarks) text += remark + "\n";
  }
  text += fmt::format("{} pairs by {} of {} rests of the robot and {} of the tracker\n", pairing.pairs.size(),
                      name(pairing.method), paired.lists.joints.size(), paired.lists.measured.size());
  if (pairing.method == PairingMethod::time)
    text += fmt::format(
        "the tracker's clock is {:+.3f} s off and drifts by {:.1f} ppm; begins and ends agree to {:.3f} s\n",
        pairing.offset, 1e6 * pairing.drift, pairing.timing_error);
  if (!paired.lists.predicted.empty())
    text += fmt::format("distances between successive points differ from the nominal model's by {:.2f} mm (median)\n",
                        1e3 * pairing.distance_error);
  text += lines_alone(option.joints, paired.joints.set, paired.lists.joints, pairing.joints_alone);
  return text + lines_alone(option.measured, paired.measured.set, paired.lists.measured, pairing.measured_alone);
}

}  // namespace kinfer::cli
