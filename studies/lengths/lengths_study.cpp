// SPDX-License-Identifier: Apache-2.0
// Lengths that users mean, with their intervals: from pin to pin on simulated machines (seeds x machines x grades), on
// a real pendulum and along the axes of a real arm.
//   ./dev study lengths                             table of the simulated machines
//   ./dev study lengths MACHINE GRADE SEEDS [SCRIPT]  one of them
//   ./dev study lengths FOLDER                      pendulum_ins and kuka_iiwa_ins in this folder
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "kinfer/base/angle.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/pipeline.hpp"
#include "kinfer/io/recording/ins_csv.hpp"
#include "kinfer/simulate/ground_truth.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "kinfer/simulate/mujoco_world.hpp"
#include "studies/lengths/arm_truth.hpp"
#include "studies/studies.hpp"

namespace kinfer::study::lengths_study {
using namespace identify;
namespace {

namespace fs = std::filesystem;

/// Errors with their stated standard deviations.
struct Scores {
  std::vector<double> error, sd;

  void add(double e, double s) { error.push_back(e), sd.push_back(s); }

  std::string text(const char* unit, double scale) const {
    if (error.empty()) return "none";
    std::vector<double> size, ratio;
    double inside = 0.0;
    for (std::size_t i = 0; i < error.size(); ++i) {
      size.push_back(scale * std::abs(error[i]));
      ratio.push_back(error[i] / sd[i]);
      inside += std::abs(ratio.back()) <= 1.96;
    }
    return fmt::format(
        "median {:.2f}, worst {:.2f} {}; sd median {:.2f}, largest {:.2f}; actual/predicted {:.2f}; "
        "{:.1f} % of {} inside 95 %",
        median(size), *std::ranges::max_element(size), unit, scale * median(sd), scale * *std::ranges::max_element(sd),
        rms(ratio), 100.0 * inside / static_cast<double>(error.size()), error.size());
  }
};

/// The line from pin to pin of a segment in its sensor's frame, by the true joints.
Vec3 true_pin_line(const MachineTruth& truth, const LinkTruth& link) {
  const auto name = [](const JointTruth& j) { return j.parent + "-" + j.child; };
  const auto from = std::ranges::find(truth.joints, link.from, name),
             to = std::ranges::find(truth.joints, link.to, name);
  const Vec3 &a = from->axis_in_child, &b = to->axis_in_parent, normal = a + std::copysign(1.0, a.dot(b)) * b;
  const auto pin = [&](const Vec3& point, const Vec3& axis) -> Vec3 {
    return point - normal.dot(point) / normal.dot(axis) * axis;
  };
  return (pin(to->point_in_parent, b) - pin(from->point_in_child, a)).normalized();
}

struct Drive {
  InsRecording recording;
  MachineTruth truth;
};

Drive simulated(const std::string& machine, const std::string& grade, Script script, std::uint64_t seed) {
  const auto mjcf = machine_mjcf(machine, {}, Rng(seed).stream(1)).value();
  const MujocoWorld world = MujocoWorld::load(mjcf).value();
  const auto drive = make_drive(world.machine(), {.script = script}, Rng(seed).stream(2)).value();
  const MachineMotion motion = world.prescribe(drive, 200.0);
  return {simulate_recording(world.machine(), motion, *sensor_grade(grade), {}, Rng(seed).stream(3)),
          machine_truth(world.machine(), motion)};
}

void run_simulated(const std::string& machine, const std::string& grade, int seeds, Script script) {
  Scores distance, line;
  int failed = 0, missing = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Drive drive = simulated(machine, grade, script, static_cast<std::uint64_t>(seed));
    const auto found = identify_machine(drive.recording, {}, Rng(1));
    if (!found) {
      ++failed;
      continue;
    }
    for (const LinkTruth& t : drive.truth.links) {
      if (!t.pin_distance || t.axis_angle > Angle::deg(1.0).rad()) continue;  // what pins on a machine are
      const auto link =
          std::ranges::find_if(found->links, [&](const LinkEstimate& l) { return l.from == t.from && l.to == t.to; });
      if (link == found->links.end() || !link->pin) {
        ++missing;
        continue;
      }
      distance.add(link->pin->distance - *t.pin_distance, link->pin->sd);
      const Vec3 true_line = true_pin_line(drive.truth, t);
      line.add(std::asin(std::min(1.0, link->pin->direction.cross(true_line).norm())), link->pin->direction_sd);
    }
  }
  fmt::print("{} {}, {} seeds ({} failed, {} pins missing)\n  pin to pin: {}\n  line of the pins: {}\n", machine, grade,
             seeds, failed, missing, distance.text("mm", 1e3), line.text("mrad", 1e3));
}

void run_pendulum(const fs::path& file) {
  constexpr double truth = 0.519;  // [m] hinge to hinge by optical markers, both segments
  const auto recording = read_ins_csv(file);
  if (!recording) return fmt::print("{}\n", recording.error().what);
  const auto found = identify_machine(*recording, {.root = "S3"}, Rng(1));
  if (!found) return fmt::print("{}: {}\n", file.filename().string(), found.error().what);
  for (const LinkEstimate& link : found->links)
    if (link.pin)
      fmt::print("{} {}: pin to pin {:.1f} mm, sd {:.1f}; truth {:.1f}; {:+.2f} sd; line of the pins to {:.2f} deg\n",
                 file.filename().string(), link.segment, 1e3 * link.pin->distance, 1e3 * link.pin->sd, 1e3 * truth,
                 (link.pin->distance - truth) / link.pin->sd, Angle::rad(link.pin->direction_sd).deg());
    else
      fmt::print("{} {}: no parallel pins\n", file.filename().string(), link.segment);
}

void run_arm(const fs::path& folder, const std::string& trial) {
  constexpr double truth = 0.4;                                          // [m] J2 to J4 and J4 to J6
  const std::vector<std::string> sensors{"D", "A", "F", "B", "E", "C"};  // on links 1 to 6
  const auto recording = read_ins_csv(folder / (trial + "_imu.csv"));
  if (!recording) return fmt::print("{}\n", recording.error().what);
  const auto rotations = link_rotations(*recording, folder / (trial + "_encoders.csv"), sensors);
  const auto found = identify_machine(*recording, {.root = "D"}, Rng(1));
  if (!rotations || !found)
    return fmt::print("{}: {}\n", trial, rotations ? found.error().what : rotations.error().what);
  for (const AxisError& e : axis_errors(*found, sensors, *rotations))
    fmt::print("{} joint {} in {}: axis {:.2f} deg off, sd {:.2f}; {:.1f} sd\n", trial, e.joint, e.sensor,
               Angle::rad(e.angle).deg(), Angle::rad(e.sd).deg(), e.angle / e.sd);
  for (const int middle : {3, 5})
    if (const auto l = axial_length(*found, sensors, middle))
      fmt::print("{} joint {} to {}: {:.0f} mm, sd {:.0f}; truth {:.0f}; {:+.2f} sd\n", trial, middle - 1, middle + 1,
                 1e3 * l->length, 1e3 * l->sd, 1e3 * truth, (l->length - truth) / l->sd);
    else
      fmt::print("{} joint {} to {}: not in one chain\n", trial, middle - 1, middle + 1);
}

void run_measured(const fs::path& folder) {
  for (const char* test : {"test1.csv", "test2.csv", "test3.csv"}) run_pendulum(folder / "pendulum_ins" / test);
  for (const char* trial : {"trial1", "trial3"}) run_arm(folder / "kuka_iiwa_ins", trial);
}

Script script_named(const std::string& name) {
  return name == "gentle" ? Script::gentle : name == "together" ? Script::together : Script::standard;
}

}  // namespace
}  // namespace kinfer::study::lengths_study

int kinfer::study::run_lengths(int argc, char** argv) {
  using namespace kinfer;
  if (argc == 2) {
    lengths_study::run_measured(argv[1]);
    return 0;
  }
  if (argc > 3) {
    lengths_study::run_simulated(argv[1], argv[2], std::atoi(argv[3]),
                                 lengths_study::script_named(argc > 4 ? argv[4] : "standard"));
    return 0;
  }
  for (const char* machine : {"excavator", "excavator-general"})
    for (const char* grade : {"noise", "industrial"})
      lengths_study::run_simulated(machine, grade, 20, Script::standard);
  return 0;
}
