#include "kinfer/simulate/excitation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

constexpr double pause = 0.5;              // [s] after each movement
constexpr double alone = 6.0;              // [s] of a joint on its own
constexpr double last_rest = 0.5;          // [s] besides the pause
constexpr double longest_ramp = 1.5;       // [s] of a window
constexpr double shortest_movement = 1.0;  // [s]
constexpr double grid = 0.005;             // [s] on which the largest rate is looked for

/// s rises from 0 at x = 0 to 1 at x = 1 with four derivatives that vanish at both ends.
JointState smooth_step(double x) {
  if (x <= 0.0) return {0.0, 0.0, 0.0};
  if (x >= 1.0) return {1.0, 0.0, 0.0};
  const double x3 = x * x * x, y = 1.0 - x, y3 = y * y * y;
  return {x3 * x * x * (126.0 + x * (-420.0 + x * (540.0 + x * (-315.0 + x * 70.0)))), 630.0 * x3 * x * y3 * y,
          2520.0 * x3 * y3 * (1.0 - 2.0 * x)};
}

JointState product(const JointState& a, const JointState& b) {
  return {a.q * b.q, a.qd * b.q + a.q * b.qd, a.qdd * b.q + 2.0 * a.qd * b.qd + a.q * b.qdd};
}

JointState window(const Movement& movement, double time) {
  const double ramp = std::min(longest_ramp, 0.5 * (movement.end - movement.begin));
  const auto step = [ramp](double since, double sense) {
    const JointState s = smooth_step(since / ramp);
    return JointState{s.q, sense * s.qd / ramp, s.qdd / (ramp * ramp)};
  };
  return product(step(time - movement.begin, 1.0), step(movement.end - time, -1.0));
}

JointState state_at(const Movement& movement, double time) {
  if (time <= movement.begin || time >= movement.end) return {};
  JointState sum;
  for (const Wave& wave : movement.waves) {
    const double omega = 2.0 * std::numbers::pi * wave.frequency;
    const double angle = omega * (time - movement.begin) + wave.phase;
    sum.q += wave.amplitude * std::sin(angle);
    sum.qd += wave.amplitude * omega * std::cos(angle);
    sum.qdd -= wave.amplitude * omega * omega * std::sin(angle);
  }
  return product(window(movement, time), sum);
}

/// What a movement may reach at most.
struct Reach {
  double excursion = 0.0;
  double rate = 0.0;
  double acceleration = 0.0;
};

Reach reached(const Movement& movement) {
  Reach reach;
  for (double t = movement.begin; t <= movement.end; t += grid) {
    const JointState state = state_at(movement, t);
    reach.excursion = std::max(reach.excursion, std::abs(state.q));
    reach.rate = std::max(reach.rate, std::abs(state.qd));
    reach.acceleration = std::max(reach.acceleration, std::abs(state.qdd));
  }
  return reach;
}

struct Band {
  double low, high;  // [Hz]
};
constexpr Band machine_bands[] = {{0.12, 0.25}, {0.3, 0.45}, {0.45, 0.65}};
constexpr Band base_bands[] = {{0.3, 0.5}, {0.6, 0.8}, {0.9, 1.2}};

/// Waves of about equal rates, one a band and `pace` times as fast, as large as `most` allows.
Movement draw_movement(double begin, double end, const Reach& most, std::span<const Band> bands, double pace, Rng rng) {
  Movement movement{.begin = begin, .end = end};
  for (const Band& band : bands) {
    const double frequency = pace * rng.uniform(band.low, band.high);
    movement.waves.push_back({rng.uniform(0.6, 1.0) / frequency, frequency, rng.uniform(0.0, 2.0 * std::numbers::pi)});
  }
  const Reach unscaled = reached(movement);
  const double scale = std::min(
      {most.excursion / unscaled.excursion, most.rate / unscaled.rate, most.acceleration / unscaled.acceleration});
  for (Wave& wave : movement.waves) wave.amplitude *= scale;
  return movement;
}

double size_of(Script script) {
  return script == Script::gentle ? 0.45 : script == Script::vigorous ? 1.8 : 1.0;
}

/// How much faster the waves are than the standard drive's.
double pace_of(Script script) {
  return script == Script::quick ? 4.0 : 1.0;
}

/// Rest, a phase for each of `joints`, a phase for all, rest; as the script has them.
Result<std::vector<Phase>> plan(const std::vector<std::string>& joints, const ExcitationOptions& options) {
  const bool one_by_one = options.script != Script::together, all = options.script != Script::sequential;
  const double together = options.script == Script::together ? 30.0 : 16.0;
  const double n = one_by_one ? static_cast<double>(joints.size()) : 0.0, movements = n + (all ? 1.0 : 0.0);
  const double still = options.rest + movements * pause + last_rest, moving = n * alone + (all ? together : 0.0);
  const double stretch = options.duration > 0.0 ? (options.duration - still) / moving : 1.0;
  const double shortest = stretch * (one_by_one ? alone : together);
  if (shortest < shortest_movement)
    return error("a duration of {} s is too short for this script: {:.1f} s at least", options.duration,
                 still + moving * shortest_movement / (one_by_one ? alone : together));
  std::vector<Phase> phases{{"rest", 0.0, options.rest}};
  const auto add = [&](const std::string& what, double length) {
    const double begin = phases.size() == 1 ? options.rest : phases.back().end + pause;
    phases.push_back({what, begin, begin + stretch * length});
  };
  if (one_by_one)
    for (const std::string& joint : joints) add(joint, alone);
  if (all) add("all", together);
  phases.push_back({"rest", phases.back().end, phases.back().end + pause + last_rest});
  return phases;
}

Reach most_of_joint(const Joint& joint, double home, const ExcitationOptions& options) {
  const bool turns = joint.type == JointType::revolute;
  const double room = std::min(joint.upper - home, home - joint.lower), size = size_of(options.script),
               pace = pace_of(options.script);
  return {std::min(size, 1.0) * std::min(0.95 * room, turns ? 0.8 : 1.0),
          size * (turns ? options.turn_rate : options.slide_rate),
          size * pace * (turns ? options.turn_acceleration : options.slide_acceleration)};
}

Reach most_of_base(const Joint& joint, const ExcitationOptions& options) {
  const bool slides = joint.type == JointType::prismatic;
  const double excursion = slides                     ? options.heave
                           : joint.name == "base_yaw" ? options.yawing.rad()
                                                      : options.rocking.rad();
  return {excursion, slides ? options.slide_rate : 0.25 * options.turn_rate,
          slides ? options.slide_acceleration : 0.5 * options.turn_acceleration};
}

std::vector<Movement> base_movements(const Joint& joint, const std::vector<Phase>& phases,
                                     const ExcitationOptions& options, Rng rng) {
  return {draw_movement(phases.front().end, phases.back().begin, most_of_base(joint, options), base_bands, 1.0, rng)};
}

std::vector<Movement> joint_movements(const Joint& joint, double home, const std::vector<Phase>& phases,
                                      const ExcitationOptions& options, Rng rng) {
  std::vector<Movement> movements;
  for (std::size_t p = 0; p < phases.size(); ++p) {
    const Phase& phase = phases[p];
    if (phase.what != joint.name && phase.what != "all") continue;
    Reach most = most_of_joint(joint, home, options);
    if (phase.what == "all")
      most = {most.excursion, options.together * most.rate, options.together * most.acceleration};
    movements.push_back(
        draw_movement(phase.begin, phase.end, most, machine_bands, pace_of(options.script), rng.stream(p)));
  }
  return movements;
}

}  // namespace

JointState state_at(const JointDrive& drive, double time) {
  JointState sum{drive.home, 0.0, 0.0};
  for (const Movement& movement : drive.movements) {
    const JointState state = state_at(movement, time);
    sum.q += state.q;
    sum.qd += state.qd;
    sum.qdd += state.qdd;
  }
  return sum;
}

Result<Drive> make_drive(const Machine& machine, const ExcitationOptions& options, Rng rng) {
  const std::vector<std::string> names = reading_names(machine.chain);
  const std::vector<int> moving = joints_with_reading(machine.chain);
  KINFER_EXPECT(machine.home.size() == static_cast<Eigen::Index>(names.size()));
  KINFER_TRY(phases, plan({names.begin() + machine.base_readings, names.end()}, options));
  Drive drive{.phases = phases, .duration = phases.back().end};
  for (std::size_t k = 0; k < names.size(); ++k) {
    const Joint& joint = machine.chain.joints[moving[k]];
    const double home = machine.home[static_cast<Eigen::Index>(k)];
    const bool of_base = static_cast<int>(k) < machine.base_readings;
    drive.joints.push_back({home, of_base ? base_movements(joint, phases, options, rng.stream(k))
                                          : joint_movements(joint, home, phases, options, rng.stream(k))});
  }
  return drive;
}

}  // namespace kinfer
