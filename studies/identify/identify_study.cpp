// SPDX-License-Identifier: Apache-2.0
// Seeds x machines x grades: errors of the identified geometry, and coverage of its confidence intervals.
// `./dev study identify sweep 60`: four machines, 60 seeds each, as a sweep of the whole command on all cores.
// `./dev study identify MACHINE GRADE SEEDS [words]`: the fit alone, in circumstances that the words name.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "kinfer/estimate/continuous/solver/noise_update.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/geometry/link_estimates.hpp"
#include "kinfer/identify/refinement/refine.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"
#include "kinfer/inertial/sensor_grading.hpp"
#include "kinfer/io/recording/ins_csv.hpp"
#include "kinfer/simulate/compliant_mounts.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "kinfer/simulate/mujoco_world.hpp"
#include "studies/identify/identify_sweep.hpp"
#include "studies/studies.hpp"
#include "studies/support/truth_scores.hpp"

namespace kinfer::study::identify_study {
using namespace identify;
namespace {

struct Setup {
  std::string machine = "excavator-general", grade = "industrial";
  Script script = Script::standard;
  Base base = Base::still;
  double slope = 0.0;
  SensorFaults faults;
  double accelerometer_range = 0.0, gyro_range = 0.0;  // [m/s²], [rad/s]; 0: the grade's
  std::optional<Servo> servo;                          // forward dynamics instead of prescribed motion
  double tilt = 0.0;                                   // [rad] tilt of foam mounts under the sensors' weight
  double sampling_rate = 200.0;                        // [Hz]
  int seeds = 4;
  double knot_spacing = 0.0;         // [s]; 0: chosen
  bool constant_biases = false;      // of the simulated sensors
  bool fit_constant_biases = false;  // the fit assumes constant biases although they vary
  double duration = 0.0;             // [s]; 0: the script's own
};

struct Drive {
  InsRecording recording;
  MachineTruth truth;
};

Drive simulated(const Setup& setup, std::uint64_t seed) {
  const auto mjcf =
      machine_mjcf(setup.machine, {.base = setup.base, .slope = Angle::deg(setup.slope)}, Rng(seed).stream(1)).value();
  const MujocoWorld world = MujocoWorld::load(mjcf).value();
  const auto drive =
      make_drive(world.machine(), {.script = setup.script, .duration = setup.duration}, Rng(seed).stream(2)).value();
  const MachineMotion motion = setup.servo ? world.drive(drive, setup.sampling_rate, *setup.servo).value()
                                           : world.prescribe(drive, setup.sampling_rate);
  SensorModel grade = *sensor_grade(setup.grade);
  if (setup.accelerometer_range > 0.0) grade.accelerometer.range = setup.accelerometer_range;
  if (setup.gyro_range > 0.0) grade.gyroscope.range = setup.gyro_range;
  if (setup.constant_biases) grade.accelerometer.instability = grade.gyroscope.instability = 0.0;
  const MachineMotion measured = setup.tilt > 0.0 ? with_foam_mounts(motion, setup.tilt, Rng(seed).stream(4)) : motion;
  return {simulate_recording(world.machine(), measured, grade, setup.faults, Rng(seed).stream(3)),
          machine_truth(world.machine(), motion)};
}

/// Link lengths alone: a tilting sensor has no constant frame to compare in.
struct Lengths {
  std::vector<double> off, ratio;
};

void compare_lengths(const std::vector<JointEstimate>& joints, const MachineTruth& truth, Lengths& lengths) {
  for (const LinkEstimate& link : link_estimates(joints)) {
    const auto t = std::ranges::find(truth.links, link.segment, &LinkTruth::segment);
    if (t == truth.links.end()) continue;
    const double off = link.length - t->length;
    lengths.off.push_back(1e3 * std::abs(off));
    lengths.ratio.push_back(off / link.sd);
    fmt::print("  {} {:.1f} mm, {:+.2f}, sd {:.2f}", link.segment, 1e3 * t->length, 1e3 * off, 1e3 * link.sd);
  }
  fmt::print("\n");
}

void print_summary(const Lengths& lengths) {
  const auto inside = std::ranges::count_if(lengths.ratio, [](double r) { return std::abs(r) <= 1.96; });
  fmt::print("lengths: median {:.2f}, worst {:.2f} mm off; actual/predicted {:.2f}; coverage {:.1f} % of {}\n",
             median(lengths.off), *std::ranges::max_element(lengths.off), rms(lengths.ratio),
             100.0 * static_cast<double>(inside) / static_cast<double>(lengths.off.size()), lengths.off.size());
}

void run(const Setup& setup) {
  std::vector<double> lines, directions, ratios;
  double inside = 0.0, scalars = 0.0;
  Lengths lengths;
  for (int seed = 1; seed <= setup.seeds; ++seed) {
    const Drive drive = simulated(setup, static_cast<std::uint64_t>(seed));
    const auto begin = std::chrono::steady_clock::now();
    const auto ordered = order_segments(drive.recording, {}, drive.truth.root, 0);
    if (!ordered) {
      fmt::print("seed {}: {}\n", seed, ordered.error().what);
      continue;
    }
    const RecordedMotion* motion = &ordered->motion;
    const SegmentTree* tree = &ordered->tree;
    std::vector<InitialJoint> starts;
    for (std::size_t i = 1; i < tree->order.size(); ++i)
      starts.push_back(estimate_initial_joint(*motion, *tree, *tree->parent[tree->order[i]], tree->order[i],
                                              EstimatedJointType::revolute));
    const auto started = std::chrono::steady_clock::now();
    SensorModel grade = estimate_sensor_model(drive.recording);
    if (setup.fit_constant_biases) grade.accelerometer.instability = grade.gyroscope.instability = 0.0;
    const auto found =
        refine(drive.recording, *motion, *tree, starts, {.grade = grade, .knot_spacing = setup.knot_spacing});
    const auto done = std::chrono::steady_clock::now();
    if (!found) {
      fmt::print("seed {}: {}\n", seed, found.error().what);
      continue;
    }
    std::vector<JointEstimate> joints;
    for (const RefinedJoint& joint : found->joints) joints.push_back(joint.estimate);
    compare_lengths(joints, drive.truth, lengths);
    const GeometryScore score = geometry_score(joints, drive.truth);
    const auto seconds = [](auto a, auto b) { return std::chrono::duration<double>(b - a).count(); };
    fmt::print(
        "seed {}: line {:.2f} mm, direction {:.2f} mrad, azimuth {:.1f} mrad, axial offset {:.2f} mm; {} iterations {} "
        "cost "
        "{:.0f}; "
        "{:.2f} + {:.2f} s, {}, knots {:.3f} s\n",
        seed, 1e3 * score.line, 1e3 * score.direction, 1e3 * score.azimuth, 1e3 * score.axial_offset,
        found->fit.iterations, name(found->fit.stop), found->fit.cost.total, seconds(begin, started),
        seconds(started, done), found->grade, found->knot_spacing);
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
  print_summary(lengths);
}

/// A recording of a real machine with given joint types, one for each joint in the order of the tree.
void run_log(const std::string& path, const std::string& root, const std::vector<EstimatedJointType>& types,
             double knot_spacing) {
  const auto recording = read_ins_csv(path).value();
  const auto ordered = order_segments(recording, {}, root, 0).value();
  const RecordedMotion& motion = ordered.motion;
  const SegmentTree& tree = ordered.tree;
  std::vector<InitialJoint> starts;
  for (std::size_t i = 1; i < tree.order.size(); ++i)
    starts.push_back(estimate_initial_joint(motion, tree, *tree.parent[tree.order[i]], tree.order[i], types.at(i - 1)));
  const auto found = refine(recording, motion, tree, starts, {.knot_spacing = knot_spacing}).value();
  fmt::print("{} iterations {} cost {:.0f} {}\n", found.fit.iterations, name(found.fit.stop), found.fit.cost.total,
             found.grade);
  for (std::size_t s = 0; s < found.fit.cost.sensors.size(); ++s) {
    const SensorFit& f = found.fit.cost.sensors[s];
    const InsNoise& noise = found.noise[s];
    fmt::print("{}: noise angular velocity {:.4f} force {:.4f}, persistent variance {:.2f} {:.2f}\n",
               motion.segments[s].name, noise.angular_velocity, noise.force, persistent_variance(f.angular_velocity),
               persistent_variance(f.force));
  }
  for (const RefinedJoint& joint : found.joints) {
    const JointEstimate& j = joint.estimate;
    const auto vector = [](const char* name, const Vec3& v) {
      fmt::print(" {} {:.5f} {:.5f} {:.5f}", name, v.x(), v.y(), v.z());
    };
    fmt::print("joint {} {}", j.parent, j.child);
    vector("axis_in_parent", j.axis_in_parent);
    vector("axis_in_child", j.axis_in_child);
    vector("point_in_parent", j.point_in_parent);
    vector("point_in_child", j.point_in_child);
    fmt::print(" sd mrad {:.2f} {:.2f} mm {:.2f} {:.2f} {:.2f}\n", 1e3 * j.sd.axis_in_parent[0],
               1e3 * j.sd.axis_in_child[0], 1e3 * j.sd.point_in_parent[0], 1e3 * j.sd.point_in_child[0],
               1e3 * j.sd.along_axis);
  }
  std::vector<JointEstimate> joints;
  for (const RefinedJoint& joint : found.joints) joints.push_back(joint.estimate);
  for (const LinkEstimate& link : link_estimates(joints))
    fmt::print("link {} {:.2f} mm sd {:.2f}\n", link.segment, 1e3 * link.length, 1e3 * link.sd);
}

}  // namespace
}  // namespace kinfer::study::identify_study

int kinfer::study::run_identify(int argc, char** argv) {
  using namespace kinfer;
  if (argc > 1 && std::string(argv[1]) == "sweep") return run_identify_sweep(argc - 1, argv + 1);
  identify_study::Setup setup;
  if (argc > 4 && std::string(argv[1]) == "log") {
    std::vector<EstimatedJointType> types;
    for (const char letter : std::string(argv[4]))
      types.push_back(letter == 's'   ? EstimatedJointType::spherical
                      : letter == 'u' ? EstimatedJointType::universal
                      : letter == 'p' ? EstimatedJointType::prismatic
                                      : EstimatedJointType::revolute);
    identify_study::run_log(argv[2], argv[3], types, argc > 5 ? std::atof(argv[5]) : 0.0);
    return 0;
  }
  if (argc > 1) setup.machine = argv[1];
  if (argc > 2) setup.grade = argv[2];
  if (argc > 3) setup.seeds = std::atoi(argv[3]);
  for (int i = 4; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.ends_with("s") && !word.ends_with("knots") && std::atof(word.c_str()) > 0.0)
      setup.duration = std::atof(word.c_str());
    if (word.ends_with("knots")) setup.knot_spacing = std::atof(word.c_str());
    if (word == "steady") setup.constant_biases = true;
    if (word == "constant") setup.fit_constant_biases = true;
    if (word == "gentle") setup.script = Script::gentle;
    if (word == "together") setup.script = Script::together;
    if (word == "quick") setup.script = Script::quick;
    if (word == "vigorous") setup.script = Script::vigorous;
    if (word == "spiky") setup.faults.spikes = 6.0;
    if (word == "gappy") setup.faults.missing = 0.05;
    if (word == "disturbed") setup.faults.magnetic_disturbance = 10.0;
    if (word == "nomag") setup.faults.has_magnetometer = false;
    if (word == "saturated") setup.accelerometer_range = 12.0, setup.gyro_range = 0.6;
    if (word == "stiff") setup.servo = Servo::stiff;
    if (word == "soft") setup.servo = Servo::soft;
    if (word == "foam") setup.tilt = 0.08, setup.sampling_rate = 50.0;
    if (word == "tape") setup.tilt = 0.02, setup.sampling_rate = 50.0;
    if (word == "slope") setup.slope = 8.0;
    if (word == "rocking") setup.base = Base::rocking;
    if (word == "yawing") setup.base = Base::yawing;
  }
  identify_study::run(setup);
  return 0;
}
