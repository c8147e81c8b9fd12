// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/excitation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

constexpr double pause = 0.5;                  // [s] after each movement
constexpr double single_joint_duration = 6.0;  // [s] of a joint on its own
constexpr double last_rest = 0.5;              // [s] besides the pause
constexpr double longest_ramp = 1.5;           // [s] of the window function
constexpr double shortest_movement = 1.0;      // [s]
constexpr double search_step = 0.005;          // [s] sampling step of the search for extrema

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

/// Extrema of a movement, or limits on them.
struct MotionExtrema {
  double excursion = 0.0;
  double velocity = 0.0;
  double acceleration = 0.0;
};

MotionExtrema find_extrema(const Movement& movement) {
  MotionExtrema extrema;
  for (double t = movement.begin; t <= movement.end; t += search_step) {
    const JointState state = state_at(movement, t);
    extrema.excursion = std::max(extrema.excursion, std::abs(state.q));
    extrema.velocity = std::max(extrema.velocity, std::abs(state.qd));
    extrema.acceleration = std::max(extrema.acceleration, std::abs(state.qdd));
  }
  return extrema;
}

struct FrequencyBand {
  double low, high;  // [Hz]
};
constexpr FrequencyBand machine_bands[] = {{0.12, 0.25}, {0.3, 0.45}, {0.45, 0.65}};
constexpr FrequencyBand base_bands[] = {{0.3, 0.5}, {0.6, 0.8}, {0.9, 1.2}};

/// Waves of about equal velocity amplitude, one per frequency band (times `pace`), as large as `most` allows.
Movement draw_movement(double begin, double end, const MotionExtrema& limits, std::span<const FrequencyBand> bands,
                       double frequency_factor, Rng rng) {
  Movement movement{.begin = begin, .end = end};
  for (const FrequencyBand& band : bands) {
    const double frequency = frequency_factor * rng.uniform(band.low, band.high);
    movement.waves.push_back({rng.uniform(0.6, 1.0) / frequency, frequency, rng.uniform(0.0, 2.0 * std::numbers::pi)});
  }
  const MotionExtrema unscaled = find_extrema(movement);
  const double scale = std::min({limits.excursion / unscaled.excursion, limits.velocity / unscaled.velocity,
                                 limits.acceleration / unscaled.acceleration});
  for (Wave& wave : movement.waves) wave.amplitude *= scale;
  return movement;
}

double amplitude_factor_of(Script script) {
  return script == Script::gentle ? 0.45 : script == Script::vigorous ? 1.8 : 1.0;
}

/// Frequency factor relative to the standard drive.
double frequency_factor_of(Script script) {
  return script == Script::quick ? 4.0 : 1.0;
}

/// Rest, a phase for each of `joints`, a phase for all, rest, as far as the script has them.
Result<std::vector<Phase>> plan_phases(const std::vector<std::string>& joints, const ExcitationOptions& options) {
  const bool one_by_one = options.script != Script::together, all = options.script != Script::sequential;
  const double together = options.script == Script::together ? 30.0 : 16.0;
  const double n = one_by_one ? static_cast<double>(joints.size()) : 0.0, movements = n + (all ? 1.0 : 0.0);
  const double still = options.rest + movements * pause + last_rest,
               moving = n * single_joint_duration + (all ? together : 0.0);
  const double time_scale = options.duration > 0.0 ? (options.duration - still) / moving : 1.0;
  const double shortest = time_scale * (one_by_one ? single_joint_duration : together);
  if (shortest < shortest_movement)
    return error("a duration of {} s is too short for this script: {:.1f} s at least", options.duration,
                 still + moving * shortest_movement / (one_by_one ? single_joint_duration : together));
  std::vector<Phase> phases{{"rest", 0.0, options.rest}};
  const auto add = [&](const std::string& what, double length) {
    const double begin = phases.size() == 1 ? options.rest : phases.back().end + pause;
    phases.push_back({what, begin, begin + time_scale * length});
  };
  if (one_by_one)
    for (const std::string& joint : joints) add(joint, single_joint_duration);
  if (all) add("all", together);
  phases.push_back({"rest", phases.back().end, phases.back().end + pause + last_rest});
  return phases;
}

MotionExtrema joint_limits(const Joint& joint, double home, const ExcitationOptions& options) {
  const bool is_revolute = rotates(joint.type);
  const double room = std::min(joint.upper - home, home - joint.lower), size = amplitude_factor_of(options.script),
               frequency_factor = frequency_factor_of(options.script);
  return {std::min(size, 1.0) * std::min(0.95 * room, is_revolute ? 0.8 : 1.0),
          size * (is_revolute ? options.max_angular_velocity : options.max_velocity),
          size * frequency_factor * (is_revolute ? options.max_angular_acceleration : options.max_acceleration)};
}

MotionExtrema base_limits(const Joint& joint, const ExcitationOptions& options) {
  const bool is_prismatic = translates(joint.type);
  const double excursion = is_prismatic               ? options.heave
                           : joint.name == "base_yaw" ? options.yawing.rad()
                                                      : options.rocking.rad();
  return {excursion, is_prismatic ? options.max_velocity : 0.25 * options.max_angular_velocity,
          is_prismatic ? options.max_acceleration : 0.5 * options.max_angular_acceleration};
}

std::vector<Movement> base_movements(const Joint& joint, const std::vector<Phase>& phases,
                                     const ExcitationOptions& options, Rng rng) {
  return {draw_movement(phases.front().end, phases.back().begin, base_limits(joint, options), base_bands, 1.0, rng)};
}

std::vector<Movement> joint_movements(const Joint& joint, double home, const std::vector<Phase>& phases,
                                      const ExcitationOptions& options, Rng rng) {
  std::vector<Movement> movements;
  for (std::size_t p = 0; p < phases.size(); ++p) {
    const Phase& phase = phases[p];
    if (phase.what != joint.name && phase.what != "all") continue;
    MotionExtrema limits = joint_limits(joint, home, options);
    if (phase.what == "all")
      limits = {limits.excursion, options.together * limits.velocity, options.together * limits.acceleration};
    movements.push_back(draw_movement(phase.begin, phase.end, limits, machine_bands,
                                      frequency_factor_of(options.script), rng.stream(p)));
  }
  return movements;
}

}  // namespace

JointState state_at(const JointTrajectory& drive, double time) {
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
  const std::vector<std::string> names = active_joint_names(machine.chain);
  const std::vector<int> moving = active_joints(machine.chain);
  KINFER_EXPECT(machine.home.size() == static_cast<Eigen::Index>(names.size()));
  KINFER_TRY(phases, plan_phases({names.begin() + machine.base_dof, names.end()}, options));
  Drive drive{.phases = phases, .duration = phases.back().end};
  for (std::size_t k = 0; k < names.size(); ++k) {
    const Joint& joint = machine.chain.joints[moving[k]];
    const double home = machine.home[static_cast<Eigen::Index>(k)];
    const bool of_base = static_cast<int>(k) < machine.base_dof;
    drive.joints.push_back({home, of_base ? base_movements(joint, phases, options, rng.stream(k))
                                          : joint_movements(joint, home, phases, options, rng.stream(k))});
  }
  return drive;
}

}  // namespace kinfer
