// SPDX-License-Identifier: Apache-2.0
// Chains updated by another drive of the same simulated machine: as it was, after a sensor was turned, after a pin was
// moved, and by the log of another machine.
//
//   ./dev study update --help
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "kinfer/identify/pipeline.hpp"
#include "studies/studies.hpp"
#include "studies/support/arguments.hpp"
#include "studies/update/drives.hpp"

namespace kinfer::study::update_study {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double turned_by = 1.0 * degree, moved_by = 0.02;  // [rad], [m]

struct Arguments {
  std::string machine = "excavator-general", grade = "industrial", cases = "same,turned,pin,other";
  int first_seed = 1, seeds = 1;
  bool with_parts = false;
};

std::string size_text(const std::optional<ChangeSize>& size, double unit, const char* name) {
  return size ? fmt::format(" {:.3f} ± {:.3f} {}", size->value / unit, size->sd / unit, name) : "";
}

std::string text_of(const ChainUpdate& update, bool with_parts) {
  std::string text = fmt::format("chi² {:.0f}/{}", update.squared_distance, update.freedom);
  for (const ChainChange& c : update.changes)
    text += fmt::format("; {} {} on {}{}{} (ln odds {:.0f})", name(c.kind), c.name, c.segment,
                        size_text(c.angle, degree, "deg"), size_text(c.distance, 1e-3, "mm"), c.log_odds);
  if (with_parts)
    for (const ChainPartComparison& part : update.parts)
      text += fmt::format("\n    {} {} {} {:.3g} expected {:.3g}, chi² {:.1f}/{}", part.joint, part.sensor,
                          name(part.quantity), part.difference, part.sd, part.squared_distance, part.freedom);
  return text + (update.is_other_machine ? "; another machine" : "");
}

/// Of each revolute joint the standard deviation of its axis in the child's frame and the squared error over its
/// variance, per degree of freedom; then the means.
std::string score_text(const Identification& found, const MachineTruth& truth) {
  double squares = 0.0, sd = 0.0;
  int count = 0;
  std::string each;
  for (const JointEstimate& joint : found.joints)
    for (const JointTruth& right : truth.joints) {
      if (right.parent != joint.parent || right.child != joint.child || joint.type != EstimatedJointType::revolute)
        continue;
      const double variance =
          joint.sd.axis_in_child[0] * joint.sd.axis_in_child[0] + joint.sd.axis_in_child[1] * joint.sd.axis_in_child[1];
      const double sense = joint.axis_in_child.dot(right.axis_in_child) < 0.0 ? -1.0 : 1.0;
      const double square = (sense * joint.axis_in_child - right.axis_in_child).squaredNorm() / variance;
      each += fmt::format(" {:.1f}", square);
      squares += square;
      sd += std::sqrt(variance);
      ++count;
    }
  return fmt::format("axes sd {:.3f} mrad, squared error over variance{}, mean {:.2f}", 1e3 * sd / count, each,
                     squares / count);
}

void print(const Arguments& a, int seed, const char* what, const Result<Identification>& found,
           const MachineTruth& truth) {
  if (!found)
    fmt::print("{} {} {}: {}\n", a.machine, seed, what, found.error().what);
  else
    fmt::print("{} {} {}: {}; {}; {}\n", a.machine, seed, what, name(found->usability),
               found->update ? text_of(*found->update, a.with_parts) : "-", score_text(*found, truth));
  std::fflush(stdout);
}

void run_seed(const Arguments& a, int seed) {
  const auto number = static_cast<std::uint64_t>(seed);
  const auto has = [&](const char* name) { return a.cases.find(name) != std::string::npos; };
  const UpdateDrive first = update_drive({.machine = a.machine, .grade = a.grade, .machine_seed = number});
  const auto known = identify::identify_machine(first.recording, {.threads = 1}, Rng(1));
  print(a, seed, "first", known, first.truth);
  if (!known || !known->tracking) return;
  const UpdateSetup again{.machine = a.machine, .grade = a.grade, .machine_seed = number, .drive = 1};
  const auto update = [&](const char* what, const UpdateDrive& drive) {
    identify::IdentifyOptions options{.threads = 1};
    options.refine.known = known->tracking;
    print(a, seed, what, identify::identify_machine(drive.recording, options, Rng(1)), drive.truth);
  };
  const auto with = [&](auto change) {
    UpdateSetup setup = again;
    change(setup);
    return update_drive(setup);
  };
  if (has("same")) {
    const UpdateDrive drive = update_drive(again);
    print(a, seed, "alone", identify::identify_machine(drive.recording, {.threads = 1}, Rng(1)), drive.truth);
    update("same", drive);
  }
  if (has("turned")) {
    UpdateDrive drive = update_drive(again);
    turn_sensor(drive, 1 + number % (drive.recording.sensors.size() - 1), turned_by);
    update(fmt::format("turned {}", 1 + number % (drive.recording.sensors.size() - 1)).c_str(), drive);
  }
  if (has("pin"))
    update("pin", with([](UpdateSetup& s) {
             s.moved_pin = s.machine == "robot6" ? "forearm" : "stick";
             s.moved_by = moved_by;
           }));
  if (has("other")) update("other", with([](UpdateSetup& s) { s.machine_seed += 500; }));
}

}  // namespace
}  // namespace kinfer::study::update_study

int kinfer::study::run_update(int argc, char** argv) {
  update_study::Arguments a;
  ArgumentParser app("What changed on a machine: chains updated by a second log");
  app.add_option("--machine", a.machine, "As of simulate");
  app.add_option("--grade", a.grade, "Of the sensors");
  app.add_option("--cases", a.cases, "Some of same, turned, pin, other, joined by commas");
  app.add_option("--parts", a.with_parts, "on: every joint's differences");
  app.add_option("--first", a.first_seed, "First seed");
  app.add_option("--seeds", a.seeds, "How many");
  if (const auto code = app.exit_code(argc, argv)) return *code;
  for (int seed = a.first_seed; seed < a.first_seed + a.seeds; ++seed) update_study::run_seed(a, seed);
  return 0;
}
