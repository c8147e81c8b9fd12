// Seeds x machines x grades: how far the identified geometry is from the truth, and whether its intervals are honest.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/refine.hpp"
#include "kinfer/simulate/ins_simulation.hpp"
#include "kinfer/simulate/mujoco_world.hpp"
#include "studies/identify/truth_scores.hpp"

namespace kinfer::study {
namespace {

struct Setup {
  std::string machine = "excavator-general", grade = "industrial";
  Script script = Script::standard;
  Base base = Base::still;
  double slope = 0.0;
  int seeds = 4;
};

struct Drive {
  InsRecording recording;
  MachineTruth truth;
};

Drive simulated(const Setup& setup, std::uint64_t seed) {
  const auto mjcf =
      machine_mjcf(setup.machine, {.base = setup.base, .slope = Angle::deg(setup.slope)}, Rng(seed).stream(1)).value();
  const MujocoWorld world = MujocoWorld::load(mjcf).value();
  const auto drive = make_drive(world.machine(), {.script = setup.script}, Rng(seed).stream(2)).value();
  const MachineMotion motion = world.prescribe(drive, 200.0);
  return {simulated_recording(world.machine(), motion, *sensor_grade(setup.grade), {}, Rng(seed).stream(3)),
          machine_truth(world.machine(), motion)};
}

void run(const Setup& setup) {
  std::vector<double> lines, directions, ratios;
  double inside = 0.0, scalars = 0.0;
  for (int seed = 1; seed <= setup.seeds; ++seed) {
    const Drive drive = simulated(setup, static_cast<std::uint64_t>(seed));
    const auto begin = std::chrono::steady_clock::now();
    const auto motion = segment_motion(drive.recording);
    const auto tree = segment_tree(*motion, drive.truth.root);
    std::vector<JointStart> starts;
    for (std::size_t i = 1; i < tree->order.size(); ++i)
      starts.push_back(
          joint_start(*motion, *tree, *tree->parent[tree->order[i]], tree->order[i], FoundJointType::revolute));
    const auto started = std::chrono::steady_clock::now();
    const auto found = refine(drive.recording, *motion, *tree, starts, {});
    const auto done = std::chrono::steady_clock::now();
    if (!found) {
      fmt::print("seed {}: {}\n", seed, found.error().what);
      continue;
    }
    std::vector<FoundJoint> joints;
    for (const RefinedJoint& joint : found->joints) joints.push_back(joint.found);
    const GeometryScore score = geometry_score(joints, drive.truth);
    const auto seconds = [](auto a, auto b) { return std::chrono::duration<double>(b - a).count(); };
    fmt::print(
        "seed {}: line {:.2f} mm, direction {:.2f} mrad, azimuth {:.1f} mrad, slide {:.2f} mm; {} iterations {} cost "
        "{:.0f}; "
        "{:.2f} + {:.2f} s, {}\n",
        seed, 1e3 * score.line, 1e3 * score.direction, 1e3 * score.azimuth, 1e3 * score.slide, found->fit.iterations,
        name(found->fit.stop), found->fit.cost.total, seconds(begin, started), seconds(started, done), found->grade);
    if (std::getenv("DETAIL")) {
      for (std::size_t s = 0; s < found->fit.cost.sensors.size(); ++s) {
        const SensorFit& f = found->fit.cost.sensors[s];
        fmt::print("   {}: chi2/n rate {:.3f} force {:.3f} field {:.4f}\n", s, f.rate.squares / f.rate.terms,
                   f.force.squares / f.force.terms, f.field.squares / std::max(1.0, f.field.terms));
      }
      for (const ScoredScalar& s : score.scalars)
        fmt::print("   {:<28} {:9.3f} sd {:8.3f}  ratio {:6.2f}\n", s.name, 1e3 * s.error, 1e3 * s.sd, s.error / s.sd);
    }
    lines.push_back(1e3 * score.line);
    directions.push_back(1e3 * score.direction);
    for (const ScoredScalar& s : score.scalars) {
      ratios.push_back(s.error / s.sd);
      inside += std::abs(s.error) <= 1.96 * s.sd;
      scalars += 1.0;
    }
  }
  fmt::print(
      "{} {}: line median {:.2f} worst {:.2f} mm; direction median {:.2f} worst {:.2f} mrad; actual/predicted "
      "{:.2f}; coverage {:.1f} %\n",
      setup.machine, setup.grade, median(lines), *std::ranges::max_element(lines), median(directions),
      *std::ranges::max_element(directions), rms(ratios), 100.0 * inside / scalars);
}

}  // namespace
}  // namespace kinfer::study

int main(int argc, char** argv) {
  using namespace kinfer;
  study::Setup setup;
  if (argc > 1) setup.machine = argv[1];
  if (argc > 2) setup.grade = argv[2];
  if (argc > 3) setup.seeds = std::atoi(argv[3]);
  for (int i = 4; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "gentle") setup.script = Script::gentle;
    if (word == "together") setup.script = Script::together;
    if (word == "vigorous") setup.script = Script::vigorous;
    if (word == "slope") setup.slope = 8.0;
    if (word == "rocking") setup.base = Base::rocking;
    if (word == "yawing") setup.base = Base::yawing;
  }
  study::run(setup);
}
