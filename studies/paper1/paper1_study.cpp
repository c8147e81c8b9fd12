// SPDX-License-Identifier: Apache-2.0
// Paper 1 (Péntek et al. 2021) end to end: simulate its excavator, identify it by bacterial programming, and write its
// tables and figures beside the printed values. `./dev study paper1 [FOLDER] [SEEDS]`;
// docs/development/methods/paper1.md reads them.
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/pipeline.hpp"
#include "kinfer/search/evolution/genetic_programming.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "kinfer/simulate/mujoco_world.hpp"
#include "kinfer/simulate/prescribed_motion.hpp"
#include "studies/paper1/figures.hpp"
#include "studies/paper1/truth_errors.hpp"
#include "studies/studies.hpp"

namespace kinfer::study::paper1_study {
using namespace identify;
namespace {

namespace fs = std::filesystem;
constexpr double pi = std::numbers::pi;

struct Log {
  InsRecording recording;
  MachineTruth truth;
};

/// What is varied from run to run.
struct Setup {
  std::uint64_t seed = 1;
  Script script = Script::standard;
  std::string grade = "noise";
  double duration = 0.0;             // [s]; 0: the script's own
  double house_distance = 1.25;      // [m] of the house's INS from the swing axis
  double accelerometer_range = 0.0;  // [m/s²]; 0: the grade's
  double gyro_range = 0.0;           // [rad/s]; 0: the grade's
  bool second_on_boom = false;       // another INS on the boom, shifted by 0.4 m and rotated
};

Machine excavator() {
  const std::string mjcf = machine_mjcf("excavator", {}, Rng(1)).value();
  return MujocoWorld::load(mjcf).value().machine();
}

constexpr std::size_t boom = 2;

/// The machine with its boom's INS shifted by 0.4 m and rotated.
Machine with_other_boom_sensor(Machine machine) {
  MountedSensor& sensor = machine.sensors[boom];
  sensor.name = "second";
  sensor.segment_T_sensor.position += sensor.segment_T_sensor.rotation * Vec3(0.4, 0.0, 0.1);
  sensor.segment_T_sensor.rotation = sensor.segment_T_sensor.rotation * exp_so3({0.3, -0.2, 0.5});
  return machine;
}

/// Adds another INS on the boom; its joints are part of the truth like those of the first.
void add_second_on_boom(Log& log, const Machine& machine, const Drive& drive, const SensorModel& grade,
                        const Rng& rng) {
  const Machine other = with_other_boom_sensor(machine);
  const MachineMotion motion = prescribed_motion(other, drive, 200.0);
  log.recording.sensors.push_back(simulate_recording(other, motion, grade, {}, rng).sensors[boom]);
  std::ranges::copy(machine_truth(other, motion).joints, std::back_inserter(log.truth.joints));
}

Log simulated(const Setup& setup) {
  Machine machine = excavator();
  machine.sensors[1].segment_T_sensor.position *=
      setup.house_distance / machine.sensors[1].segment_T_sensor.position.norm();
  const Drive drive =
      make_drive(machine, {.script = setup.script, .duration = setup.duration}, Rng(setup.seed)).value();
  const MachineMotion motion = prescribed_motion(machine, drive, 200.0);
  SensorModel grade = sensor_grade(setup.grade).value();
  if (setup.accelerometer_range > 0.0) grade.accelerometer.range = setup.accelerometer_range;
  if (setup.gyro_range > 0.0) grade.gyroscope.range = setup.gyro_range;
  Log log{simulate_recording(machine, motion, grade, {}, Rng(setup.seed).stream(7)), machine_truth(machine, motion)};
  if (setup.second_on_boom) add_second_on_boom(log, machine, drive, grade, Rng(setup.seed).stream(8));
  return log;
}

/// The paper's method: its filter, its joint-variable candidates, its table 4.
IdentifyOptions paper_options(int links) {
  IdentifyOptions options{.engine = BacterialProgramming{.terminals = JointVariableKind::euler},
                          .links = links,
                          .geometry = GeometrySource::searched};
  options.motion.filter = PaperEkfOptions{};
  return options;
}

Identification identified(const Log& log, const IdentifyOptions& options, std::uint64_t seed) {
  auto found = identify_machine(log.recording, options, Rng(seed));
  if (!found) fmt::print(stderr, "{}\n", found.error().what), std::exit(1);
  return *found;
}

std::ofstream table(const fs::path& folder, const std::string& name, const std::string& header) {
  std::ofstream file(folder / name);
  file << header << "\n";
  return file;
}

/// Eq. (27) link by link; signals 0 .. are the excited ones of each link.
std::vector<std::vector<DhLeaf>> theoretical_links() {
  return {{{.a = -1.25, .theta_signal = 0}},
          {{.theta = pi, .alpha = -pi / 2.0, .a = -0.4}, {.a = 0.58, .theta_signal = 0}},
          {{.a = 1.285}, {.a = 0.33, .theta_signal = 0}}};
}

void write_settings(const fs::path& folder) {
  table(folder, "table1.csv", "link,theta,d [m],alpha [rad],a [m]")
      << "ground-platform,0,0,0,xG\nplatform-house,psi,0,0,-1.25\n"
         "house-boom,pi,0,-pi/"
         "2,-0.4\nhouse-boom,theta,0,0,0.58\nboom-adjustment,0,0,0,1.285\nboom-adjustment,theta,0,0,0.33\n"
         "adjustment-stick (not in the paper),0,0,0,1.62\nadjustment-stick,theta,0,0,0.75\nstick-tool (not in the "
         "paper),0,0,0,1.45\nstick-tool,theta,0,0,0.42\n";
  auto sensors = table(folder, "table2.csv", "instrument,noise density [unit/sqrt(Hz)],bias,instability,scale,range");
  const SensorModel grade = sensor_grade("noise").value();
  for (const auto& [name, i] : {std::pair{"accelerometer [m/s2]", grade.accelerometer},
                                {"gyro [rad/s]", grade.gyroscope},
                                {"magnetometer [uT]", grade.magnetometer}})
    sensors << fmt::format("{},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g}\n", name, i.noise_density, i.bias_sd, i.instability,
                           i.scale_sd, i.range);
  const BacterialProgramming s;
  table(folder, "table4.csv", "setting,value,in the paper") << fmt::format(
      "individuals,{},100\ngenerations,{},300\nclones,{},lost\ncycles,{},lost\ntransfers,{},lost\ndepth,{}-{},"
      "lost\nmost leaves,{},lost\nrows,{},a few seconds\n",
      s.bacteria.individuals, s.bacteria.generations, s.bacteria.clones, s.bacteria.cycles, s.bacteria.transfers,
      s.depth.min, s.depth.max, s.depth.max_leaves, s.rows);
}

void write_table3(const fs::path& folder, const OrderEvidence& order) {
  auto file =
      table(folder, "table3.csv", fmt::format("phase begin [s],phase end [s],{}", fmt::join(order.sensors, ",")));
  for (const PhaseEvidence& phase : order.phases) {
    file << fmt::format("{:.2f},{:.2f}", phase.begin, phase.end);
    for (const bool moves : phase.moves) file << (moves ? ",1" : ",0");
    file << "\n";
  }
  file << fmt::format("rank,,{}\n", fmt::join(order.rank, ","));
}

void write_leaves(const fs::path& folder, const std::string& name, const Identification& found,
                  std::vector<DhRowEstimate> LinkEvidence::*rows) {
  auto file = table(folder, name, "segment,theta [rad],d [m],alpha [rad],a [m]");
  const auto angle = [](double value, const std::string& variable) {
    return variable.empty() ? fmt::format("{:.4f}", value) : variable;
  };
  for (const LinkEvidence& link : found.searches)
    for (const DhRowEstimate& r : link.*rows)
      file << fmt::format("{},{},{:.4f},{},{:.4f}\n", r.segment, angle(r.row.theta, r.theta_variable), r.row.d,
                          angle(r.row.alpha, r.alpha_variable), r.row.a);
}

/// The reported leaves, with their signals looked up by name.
std::vector<DhLeaf> found_leaves(const LinkEvidence& link, std::span<const JointSignal> signals) {
  const auto index = [&](const std::string& name) {
    const auto found = std::ranges::find(signals, name, &JointSignal::name);
    return found == signals.end() ? DhLeaf::constant : static_cast<int>(found - signals.begin());
  };
  std::vector<DhLeaf> leaves;
  for (const DhRowEstimate& r : link.found)
    leaves.push_back({.theta = r.row.theta,
                      .d = r.row.d,
                      .alpha = r.row.alpha,
                      .a = r.row.a,
                      .theta_signal = index(r.theta_variable),
                      .alpha_signal = index(r.alpha_variable)});
  return leaves;
}

/// Figure 8 for one segment: measured and predicted accelerations, and residual angles.
std::vector<Chart> signal_charts(const std::string& name, const std::vector<double>& time,
                                 const std::vector<FrameState>& measured, const std::vector<FrameState>& found,
                                 const std::vector<FrameState>& theoretical, const std::vector<std::size_t>& rows) {
  std::vector<Chart> charts;
  for (int axis = 0; axis < 3; ++axis) {
    Line measured_line{"measured", {}, {}, "#999999"}, best{"found chain", {}, {}, "#1f4e79"},
        theory_line{"theoretical chain", {}, {}, "#2e7d32"}, residual{"found - measured", {}, {}, "#b03020"};
    for (const std::size_t row : rows) {
      for (Line* line : {&measured_line, &best, &theory_line, &residual}) line->x.push_back(time[row]);
      measured_line.y.push_back(measured[row].acceleration[axis]);
      best.y.push_back(found[row].acceleration[axis]);
      theory_line.y.push_back(theoretical[row].acceleration[axis]);
      residual.y.push_back(best.y.back() - measured_line.y.back());
    }
    charts.push_back({fmt::format("{}: acceleration {}", name, "xyz"[axis]),
                      "time [s]",
                      "m/s²",
                      {measured_line, best, theory_line, residual}});
  }
  Line phi{"roll", {}, {}, "#1f4e79"}, theta{"pitch", {}, {}, "#2e7d32"}, psi{"yaw", {}, {}, "#b03020"};
  for (const std::size_t row : rows) {
    const Vec3 error = euler_angles(found[row].rotation) - euler_angles(measured[row].rotation);
    Line* lines[] = {&phi, &theta, &psi};
    for (int axis = 0; axis < 3; ++axis)
      lines[axis]->x.push_back(time[row]), lines[axis]->y.push_back(1e3 * wrap_to_pi(error[axis]));
  }
  charts.push_back({name + ": residual angles of the found chain", "time [s]", "mrad", {phi, theta, psi}});
  return charts;
}

/// Found against theoretical chain on the same rows, and figure 8.
void write_table7_and_figure8(const fs::path& folder, const Log& log, const Identification& found) {
  const IdentifyOptions options = paper_options(3);
  const RecordedMotion motion = segment_motion(log.recording, options.motion).value();
  const SegmentTree tree = segment_tree(motion).value();
  auto file = table(folder, "table7.csv",
                    "segment,acceleration found,acceleration theoretical,orientation found,orientation "
                    "theoretical,total found,total theoretical,deviation [%]");
  auto theoretical = measured_states(motion.segments[tree.root]);
  auto predicted = theoretical;
  std::vector<Chart> charts;
  const auto theory = theoretical_links();
  double deviation_sum = 0.0;
  for (std::size_t link = 0; link < theory.size(); ++link) {
    const std::size_t child = tree.order[link + 1], parent = *tree.parent[child];
    const std::string& name = motion.segments[child].name;
    auto signals = find_joint_signals(motion, parent, child,
                                      {.terminals = JointVariableKind::euler, .smoothing = options.motion.smoothing});
    predicted = propagate(predicted, found_leaves(found.searches[link], signals), signals);
    std::ranges::stable_sort(signals, std::greater<>(),
                             [&](const JointSignal& s) { return s.name == (link == 0 ? "psi" : "theta"); });
    theoretical = propagate(theoretical, theory[link], signals);
    const auto rows = informative_rows(motion, parent, child, JointVariableKind::euler);
    const auto measured = measured_states(motion.segments[child]);
    const JRmse j = j_rmse(theoretical, measured, thin_rows(rows, 384), OrientationMetric::euler);
    const LinkFit& f = found.searches[link].fitted;
    const double deviation = 100.0 * (f.total - j.total) / j.total;
    deviation_sum += deviation / 3.0;
    file << fmt::format("{},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.2f}\n", name, f.acceleration, j.acceleration,
                        f.orientation, j.orientation, f.total, j.total, deviation);
    std::ranges::copy(signal_charts(name, motion.time, measured, predicted, theoretical, thin_rows(rows, 600)),
                      std::back_inserter(charts));
  }
  file << fmt::format("mean deviation,,,,,,,{:.2f}\nin the paper,,,,,,,0.31\n", deviation_sum);
  write_svg(folder / "figure8.svg", charts);
}

void write_figure9(const fs::path& folder, const Identification& found) {
  auto file = table(folder, "figure9.csv", "segment,generation,best,median");
  std::vector<Chart> charts;
  for (const LinkEvidence& link : found.searches) {
    Line best{"best", {}, link.best, "#1f4e79"}, median{"median", {}, link.median, "#b03020"};
    for (std::size_t g = 0; g < link.best.size(); ++g) {
      best.x.push_back(static_cast<double>(g));
      file << fmt::format("{},{},{:.6g},{:.6g}\n", link.segment, g, link.best[g], link.median[g]);
    }
    median.x = best.x;
    charts.push_back({"link to " + link.segment, "generation", "cost", {best, median}, Scale::logarithmic});
  }
  write_svg(folder / "figure9.svg", charts);
}

struct Errors {
  std::vector<double> line, direction;
  void add(const GeometryErrors& e) { line.push_back(1e3 * e.line), direction.push_back(1e3 * e.direction); }
  std::string summary() const {
    return fmt::format("{:.1f},{:.1f},{:.1f},{:.1f}", median(line), *std::ranges::max_element(line), median(direction),
                       *std::ranges::max_element(direction));
  }
};

Errors write_seeds(const fs::path& folder, const std::string& name, int seeds, const IdentifyOptions& options) {
  auto file = table(folder, name, "seed,worst line [mm],worst direction [mrad],azimuth [mrad],J of each link");
  Errors errors;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Log log = simulated({.seed = static_cast<std::uint64_t>(seed)});
    const Identification found = identified(log, options, static_cast<std::uint64_t>(seed));
    const GeometryErrors e = geometry_errors(found.joints, log.truth);
    errors.add(e);
    file << fmt::format("{},{:.2f},{:.2f},{:.2f}", seed, 1e3 * e.line, 1e3 * e.direction, 1e3 * e.azimuth);
    for (const LinkEvidence& link : found.searches) file << fmt::format(",{:.5f}", link.fitted.total);
    file << "\n";
  }
  file << fmt::format("median,{:.2f},{:.2f}\n", median(errors.line), median(errors.direction));
  return errors;
}

/// The paper's statements in words, three seeds a row.
void write_claims(const fs::path& folder) {
  auto file = table(folder, "claims.csv",
                    "claim,setting,median line [mm],worst line [mm],median direction [mrad],worst direction [mrad]");
  const auto row = [&](const std::string& claim, const std::string& setting, Setup setup, int links) {
    Errors errors;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      setup.seed = seed;
      const Log log = simulated(setup);
      errors.add(geometry_errors(identified(log, paper_options(links), seed).joints, log.truth));
    }
    file << claim << "," << setting << "," << errors.summary() << std::endl;
  };
  for (const double distance : {0.1, 0.3, 0.6, 1.25, 2.5})
    row("distance from the axis (house)", fmt::format("{} m", distance), {.house_distance = distance}, 1);
  for (const double duration : {30.0, 52.0, 100.0})
    row("length of the log", fmt::format("{} s", duration), {.duration = duration}, 2);
  for (const char* grade : {"noise", "industrial", "consumer"}) row("sensor grade", grade, {.grade = grade}, 2);
  row("clipping", "accelerometer 10.2 m/s2", {.accelerometer_range = 10.2}, 2);
  row("clipping", "gyro 0.4 rad/s", {.gyro_range = 0.4}, 2);
  row("a second INS on the boom", "used as a sixth sensor", {.second_on_boom = true}, 3);
}

/// Both searches with the same evaluator on the boom's link: cost over evaluations.
void write_baseline(const fs::path& folder, int seeds) {
  const IdentifyOptions options = paper_options(2);
  auto file = table(folder, "baseline.csv", "seed,evaluations,bacterial programming,genetic programming");
  std::vector<Line> lines;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Log log = simulated({.seed = static_cast<std::uint64_t>(seed)});
    const RecordedMotion motion = segment_motion(log.recording, options.motion).value();
    const auto parent = measured_states(motion.segments[1]), child = measured_states(motion.segments[2]);
    const auto signals = find_joint_signals(motion, 1, 2, {.terminals = JointVariableKind::euler});
    const LinkCost cost(parent, child, signals,
                        thin_rows(informative_rows(motion, 1, 2, JointVariableKind::euler), 384),
                        {.orientation = OrientationMetric::euler});
    const DhBreed breed(DhLeafOperators({.signals = static_cast<int>(signals.size())}), {});
    const GenomeCost<DhTree> of_tree = [&](const DhTree& tree, double bound) { return cost(tree, bound); };
    const auto bp = evolve_bacteria(breed, of_tree, {}, Rng(static_cast<std::uint64_t>(seed)));
    const auto gp = evolve_by_crossover(breed, of_tree, {}, Rng(static_cast<std::uint64_t>(seed)));
    for (std::size_t g = 0; g < bp.best_history.size(); g += 10) {
      const auto at = std::ranges::lower_bound(gp.evaluations_at, bp.evaluations_at[g]) - gp.evaluations_at.begin();
      const auto k = std::min(static_cast<std::size_t>(at), gp.best_history.size() - 1);
      file << fmt::format("{},{},{:.6g},{:.6g}\n", seed, bp.evaluations_at[g], bp.best_history[g], gp.best_history[k]);
    }
    for (const auto& [evolution, colour] : {std::pair{&bp, "#1f4e79"}, {&gp, "#b03020"}}) {
      Line line{fmt::format("{} seed {}", evolution == &bp ? "BP" : "GP", seed), {}, evolution->best_history, colour};
      line.x.assign(evolution->evaluations_at.begin(), evolution->evaluations_at.end());
      lines.push_back(std::move(line));
    }
  }
  write_svg(folder / "baseline.svg",
            {{"boom: cost over evaluations", "evaluations", "cost", lines, Scale::logarithmic}});
}

void run(const fs::path& folder, int seeds) {
  fs::create_directories(folder);
  write_settings(folder);
  const Log log = simulated({.seed = 1});
  const Identification three = identified(log, paper_options(3), 1);
  write_table3(folder, three.order);
  write_leaves(folder, "table5.csv", three, &LinkEvidence::found);
  write_leaves(folder, "table6.csv", three, &LinkEvidence::merged);
  write_table7_and_figure8(folder, log, three);
  write_figure9(folder, three);
  const Errors paper3 = write_seeds(folder, "geometry_three_links.csv", seeds, paper_options(3));
  fmt::print(
      "three links, paper's filter and joint variables: median worst line {:.1f} mm, direction {:.1f} mrad (paper: 12 "
      "mm, 1 "
      "mrad on one run)\n",
      median(paper3.line), median(paper3.direction));
  for (const LinkEngine& engine : {LinkEngine(BacterialProgramming{}), LinkEngine(MemeticProgramming{})}) {
    const IdentifyOptions ours{.engine = engine, .links = 3, .geometry = GeometrySource::searched};
    const std::string_view engine_name = name(method_of(engine));
    const Errors ours3 =
        write_seeds(folder, fmt::format("geometry_three_links_hinge_{}.csv", engine_name), seeds, ours);
    fmt::print("three links, {}, kinfer-offline and hinge: {:.1f} mm, {:.1f} mrad\n", engine_name, median(ours3.line),
               median(ours3.direction));
  }
  const Errors paper5 = write_seeds(folder, "geometry_five_links.csv", std::min(seeds, 5), paper_options(0));
  fmt::print("five links, paper's filter and joint variables: {:.1f} mm, {:.1f} mrad\n", median(paper5.line),
             median(paper5.direction));
  write_baseline(folder, std::min(seeds, 5));
  write_claims(folder);
}

}  // namespace
}  // namespace kinfer::study::paper1_study

int kinfer::study::run_paper1(int argc, char** argv) {
  paper1_study::run(argc > 1 ? argv[1] : "paper1", argc > 2 ? std::atoi(argv[2]) : 10);
  return 0;
}
