// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/diagnosis/axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/parallel.hpp"
#include "kinfer/identify/diagnosis/neighbours.hpp"
#include "kinfer/identify/diagnosis/thresholds.hpp"
#include "kinfer/inertial/diagnosis/attitude_columns.hpp"
#include "kinfer/inertial/diagnosis/section_fit.hpp"
#include "kinfer/measurement/ins/ins_screening.hpp"

namespace kinfer::identify {
namespace {

// rad/s, deg/s, mrad/s, mdeg/s, degrees that were converted twice, and no rotation: as if the gyroscope told nothing
constexpr std::array rate_units{1.0, degree, 1e-3, 1e-3 * degree, 1.0 / degree, 1e-9};
constexpr std::size_t no_rotation = 5;

/// Of one sensor, by unit and map.
struct SensorLikelihoods {
  std::array<MapLikelihoods, rate_units.size()> force{}, field{};

  double of(std::size_t unit, std::size_t map) const { return force[unit].of[map] + field[unit].of[map]; }
  std::size_t best_map(std::size_t unit) const {
    std::size_t best = 0;
    for (std::size_t m = 1; m < 48; ++m)
      if (of(unit, m) > of(unit, best)) best = m;
    return best;
  }
};

/// By each unit; the bias that there can be is another one in each.
using SignalsByUnit = std::array<std::optional<SectionSignals>, rate_units.size()>;

SignalsByUnit signals_by_unit(const TriadColumns& direction, const TriadColumns& rates, std::span<const double> time) {
  SignalsByUnit signals;
  for (std::size_t u = 0; u < rate_units.size(); ++u)
    signals[u] = section_signals(direction, rates, time, max_quiet_rate / rate_units[u]);
  return signals;
}

/// What is a bias by one unit is a steady rotation by another: all sections that tell something by any unit.
std::vector<std::size_t> sections_by_any_unit(const SignalsByUnit& signals) {
  std::set<std::size_t> sections;
  for (const auto& by_unit : signals)
    if (by_unit)
      for (const std::size_t first : telling_sections(*by_unit)) sections.insert(first);
  return {sections.begin(), sections.end()};
}

std::array<MapLikelihoods, rate_units.size()> likelihoods_of(const SignalsByUnit& signals, LeverArm lever_arm) {
  const auto sections = sections_by_any_unit(signals);
  std::array<MapLikelihoods, rate_units.size()> result{};
  for (std::size_t u = 0; u < rate_units.size(); ++u)
    if (signals[u]) result[u] = map_likelihoods(*signals[u], sections, rate_units[u], lever_arm);
  return result;
}

SensorLikelihoods likelihoods_of(const InsSensor& sensor, std::span<const double> time) {
  SensorLikelihoods result;
  result.force = likelihoods_of(signals_by_unit(sensor.acceleration, sensor.angular_velocity, time), LeverArm::free);
  if (sensor.has_magnetometer())
    result.field = likelihoods_of(signals_by_unit(sensor.field, sensor.angular_velocity, time), LeverArm::none);
  return result;
}

/// [nats] How much better the sensors are explained by one unit than by another, each counting up to `most`.
double unit_gain(const std::vector<SensorLikelihoods>& sensors, std::size_t unit, std::size_t other, double most) {
  double sum = 0.0;
  for (const SensorLikelihoods& sensor : sensors) {
    const double gain = sensor.of(unit, sensor.best_map(unit)) - sensor.of(other, sensor.best_map(other));
    sum += std::clamp(gain, -most, most);
  }
  return sum;
}

/// The unit that the sensors favour over rad/s; each counts up to a limit, so that one odd sensor does not speak for
/// all. No rotation where no unit is better than that.
std::size_t common_unit(const std::vector<SensorLikelihoods>& sensors) {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  std::size_t best = 0;
  for (std::size_t u = 1; u < rate_units.size(); ++u)
    if (unit_gain(sensors, u, best, unlimited) > 0.0) best = u;
  if (best == 0 || unit_gain(sensors, best, 0, max_sensor_vote) < min_map_gain) return 0;
  return unit_gain(sensors, best, no_rotation, unlimited) < min_map_gain ? no_rotation : best;
}

/// That of the log, unless this sensor by itself contradicts it. A sensor that stands still prefers any unit that makes
/// its bias small: another unit must explain more than no rotation does. And gravity must tell it: iron that turns with
/// a magnetometer holds its field back, as slower rates would.
std::size_t unit_of(const SensorLikelihoods& sensor, std::size_t common) {
  const auto most = [&](std::size_t unit) { return sensor.of(unit, sensor.best_map(unit)); };
  std::size_t best = common;
  for (std::size_t u = 0; u < no_rotation; ++u)
    if (most(u) > most(best)) best = u;
  const auto by_gravity = [&](std::size_t unit) { return std::ranges::max(sensor.force[unit].of); };
  const bool rotates = most(best) - most(no_rotation) > min_map_gain;
  const bool is_told =
      most(best) - most(common) > 2.0 * min_map_gain && by_gravity(best) - by_gravity(common) > min_map_gain;
  return rotates && is_told ? best : common;
}

/// Gains of the best map over the identity, and over the next one of them.
struct MapChoice {
  std::size_t map = 0;
  double gain = 0.0, lead = 0.0;
};

/// None where the best map leaves about what no rotation at all would: the motion is none that the model describes, as
/// that of a sensor waved by hand.
MapChoice best_of(const MapLikelihoods& maps, double without_rotation, double gain_per_section) {
  const auto& of = maps.of;
  MapChoice choice;
  for (std::size_t m = 1; m < of.size(); ++m)
    if (of[m] > of[choice.map]) choice.map = m;
  if (of[choice.map] - without_rotation < gain_per_section * maps.sections) return {};
  choice.gain = of[choice.map] - of[0];
  choice.lead = std::numeric_limits<double>::infinity();
  for (std::size_t m = 0; m < of.size(); ++m)
    if (m != choice.map) choice.lead = std::min(choice.lead, of[choice.map] - of[m]);
  return choice;
}

enum class OddInstrument { none, gyroscope, accelerometer, magnetometer };

/// Which instrument has other axes than the rest of its sensor, and the map that leads to theirs.
struct AxisFault {
  OddInstrument instrument = OddInstrument::none;
  Mat3 axes = Mat3::Identity();
  double gain = 0.0, lead = 0.0;
  MapLikelihoods maps{};  ///< of the gyroscope to the instruments that decided
};

AxisFault axis_fault(const SensorLikelihoods& sensor, std::size_t unit, bool has_magnetometer) {
  MapLikelihoods both{.of = {}, .sections = sensor.force[unit].sections + sensor.field[unit].sections};
  for (std::size_t m = 0; m < both.of.size(); ++m) both.of[m] = sensor.of(unit, m);
  const auto alone = [&](const std::array<MapLikelihoods, rate_units.size()>& maps) {
    return best_of(maps[unit], maps[no_rotation].of[0], min_gain_per_section_alone);
  };
  const MapChoice gyroscope = best_of(both, sensor.of(no_rotation, 0), min_gain_per_section);
  const MapChoice force = alone(sensor.force), field = alone(sensor.field);
  AxisFault best;
  const auto consider = [&](OddInstrument instrument, const MapChoice& choice, const MapLikelihoods& maps) {
    const bool is_alone = instrument != OddInstrument::gyroscope;
    if (choice.gain < (is_alone ? min_map_gain_alone : min_axes_gain) || choice.gain <= best.gain) return;
    const Mat3& axes = signed_permutations()[choice.map];
    // Negating or mirroring a direction that the gyroscope transports shows as a rotation of axes, never as a reversal.
    if (is_alone && axes.determinant() < 0.0) return;
    best = {instrument, is_alone ? Mat3(axes.transpose()) : axes, choice.gain, choice.lead, maps};
  };
  consider(OddInstrument::gyroscope, gyroscope, both);
  if (!has_magnetometer) return best;
  // One odd instrument of three: the map of the gyroscope to it alone gains, that to the other is the identity.
  const double margin = min_map_lead;
  if (force.gain > best.gain + margin) consider(OddInstrument::accelerometer, force, sensor.force[unit]);
  if (field.gain > best.gain + margin) consider(OddInstrument::magnetometer, field, sensor.field[unit]);
  return best;
}

Finding axes_finding(const InsSensor& sensor, const AxisFault& fault) {
  constexpr std::array names{"", "gyroscope", "accelerometer", "magnetometer"};
  const bool is_sense = fault.instrument == OddInstrument::gyroscope && (fault.axes + Mat3::Identity()).isZero();
  const bool is_certain = fault.lead > min_map_lead;
  return {.kind = is_sense ? FindingKind::rate_sign : FindingKind::instrument_axes,
          .severity = fault.instrument == OddInstrument::magnetometer ? Severity::warning : Severity::fault,
          .values = {{"sensor", sensor.name},
                     {"instrument", std::string(names[static_cast<std::size_t>(fault.instrument)])},
                     {"axes", describe_axes(fault.axes)},
                     {"log_likelihood_gain", fault.gain}},
          .applied = is_certain};
}

TriadColumns& odd_instrument(InsSensor& sensor, OddInstrument instrument) {
  return instrument == OddInstrument::gyroscope       ? sensor.angular_velocity
         : instrument == OddInstrument::accelerometer ? sensor.acceleration
                                                      : sensor.field;
}

/// The axes of an instrument that a map of the gyroscope to the others' stands for.
Mat3 axes_of(OddInstrument instrument, std::size_t map) {
  const Mat3& axes = signed_permutations()[map];
  return instrument == OddInstrument::gyroscope ? axes : Mat3(axes.transpose());
}

/// A sensor with the axes that it was mapped to by its own instruments.
struct MappedSensor {
  std::size_t sensor = 0;
  InsSensor before;
  AxisFault fault;
};

/// The identity, and the maps that the sensor's own instruments favour over it, likeliest first.
std::vector<std::size_t> favoured_maps(const MapLikelihoods& maps) {
  std::vector<std::size_t> favoured;
  for (std::size_t m = 1; m < maps.of.size(); ++m)
    if (maps.of[m] > maps.of[0]) favoured.push_back(m);
  std::ranges::stable_sort(favoured, [&](std::size_t a, std::size_t b) { return maps.of[a] > maps.of[b]; });
  if (favoured.size() > most_favoured_maps) favoured.resize(most_favoured_maps);
  favoured.insert(favoured.begin(), 0);
  return favoured;
}

/// The sensor with each of the maps. Where these are reflections, turned over, too, which its own instruments cannot
/// tell: a left-handed sensor shows as a reversed gyroscope.
struct MappedCandidates {
  std::vector<AxesCandidate> candidates;
  std::vector<std::size_t> map;  ///< of each
};

MappedCandidates candidates_of(const MappedSensor& mapped) {
  MappedCandidates result;
  const MapLikelihoods& maps = mapped.fault.maps;
  for (const std::size_t map : favoured_maps(maps)) {
    InsSensor sensor = mapped.before;
    transform(odd_instrument(sensor, mapped.fault.instrument), 1.0, axes_of(mapped.fault.instrument, map));
    result.candidates.push_back({sensor, maps.of[map]});
    result.map.push_back(map);
    if (signed_permutations()[map].determinant() > 0.0) continue;
    transform(sensor.acceleration, -1.0, Mat3::Identity());
    result.candidates.push_back({sensor, maps.of[map]});
    result.map.push_back(map);
  }
  return result;
}

/// What the neighbours leave of a map of axes: it, another one, or none.
AxisFault judge_by_neighbours(const InsRecording& recording, const MappedSensor& mapped, int threads) {
  const MappedCandidates tried = candidates_of(mapped);
  const AxesChoice choice = choose_axes(recording, mapped.sensor, tried.candidates, threads);
  const std::size_t map = tried.map[choice.candidate];
  // Neighbours say nothing of a magnetometer, nor of a sensor that an engine shakes at rest: of it the axes are no
  // fault.
  const bool is_of_motion = mapped.fault.instrument != OddInstrument::magnetometer;
  if (map == 0 || choice.tree_gain < (is_of_motion ? min_sign_gain : -min_sign_gain)) return {};
  AxisFault fault = mapped.fault;
  fault.axes = axes_of(fault.instrument, map);
  fault.gain = choice.gain();
  fault.lead = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < tried.map.size(); ++c)
    if (tried.map[c] != map)
      fault.lead = std::min(fault.lead, choice.log_likelihood[choice.candidate] - choice.log_likelihood[c]);
  return fault;
}

void ask_neighbours(MendedLog& log, const std::vector<MappedSensor>& mapped, int threads) {
  for (const MappedSensor& m : mapped) {
    const AxisFault fault = judge_by_neighbours(log.log(), m, threads);
    InsSensor& sensor = log.edit().sensors[m.sensor];
    sensor = m.before;
    if (fault.instrument == OddInstrument::none) continue;
    transform(odd_instrument(sensor, fault.instrument), 1.0, fault.axes);
    flag_faults(sensor);
    log.findings.push_back(axes_finding(sensor, fault));
  }
}

/// [nats] How much better the field agrees with the gyroscope as it is than with the mapped one; 0 without a field.
double field_for_gyroscope(const InsSensor& sensor, std::span<const double> time, std::size_t map) {
  if (!sensor.has_magnetometer()) return 0.0;
  const MapLikelihoods field =
      likelihoods_of(signals_by_unit(sensor.field, sensor.angular_velocity, time), LeverArm::none)[0];
  return field.of[0] - field.of[map];
}

/// All maps, each as the axes of the gyroscope; its own instruments say nothing.
std::vector<AxesCandidate> all_maps(const InsSensor& sensor) {
  std::vector<AxesCandidate> candidates;
  for (const Mat3& axes : signed_permutations()) {
    candidates.push_back({sensor, 0.0});
    transform(candidates.back().sensor.angular_velocity, 1.0, axes);
  }
  return candidates;
}

}  // namespace

std::optional<WantedAxes> axes_wanted_by_neighbours(const InsRecording& recording,
                                                    const std::vector<std::size_t>& unconnected, int threads) {
  std::optional<WantedAxes> wanted;
  double most = min_neighbours_axes_gain;
  for (const std::size_t s : unconnected) {
    const InsSensor& sensor = recording.sensors[s];
    const InsRecording excerpt = busiest_minute(recording, s);  // 48 copies of an hour would take gigabytes
    const AxesChoice choice = choose_axes(excerpt, s, all_maps(excerpt.sensors[s]), threads);
    if (choice.gain() < most) continue;
    most = choice.gain();
    const bool is_of_gyroscope = signed_permutations()[choice.candidate].determinant() < 0.0 ||
                                 field_for_gyroscope(sensor, recording.time(sensor), choice.candidate) <= 0.0;
    const OddInstrument odd = is_of_gyroscope ? OddInstrument::gyroscope : OddInstrument::accelerometer;
    const AxisFault fault{
        .instrument = odd, .axes = axes_of(odd, choice.candidate), .gain = choice.gain(), .lead = choice.lead()};
    wanted = {sensor.name, fault.axes, is_of_gyroscope, axes_finding(sensor, fault)};
  }
  return wanted && wanted->finding.applied ? wanted : std::nullopt;
}

void map_axes(InsRecording& recording, const WantedAxes& wanted) {
  for (InsSensor& sensor : recording.sensors) {
    if (sensor.name != wanted.sensor) continue;
    transform(wanted.is_of_gyroscope ? sensor.angular_velocity : sensor.acceleration, 1.0, wanted.axes);
    flag_faults(sensor);
  }
}

std::string describe_axes(const Mat3& axes) {
  std::string text;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      if (std::abs(axes(row, column)) > 0.5)
        text += fmt::format("{}{}{}", text.empty() ? "" : ", ", axes(row, column) < 0.0 ? "-" : "", "xyz"[column]);
  return text;
}

Result<void> refuse_attitudes(const InsRecording& recording) {
  std::vector<std::optional<AttitudeFit>> fits;
  for (const InsSensor& sensor : recording.sensors) fits.push_back(attitude_fit(sensor));
  // Biases may point along a single sensor's vertical by chance, but not those of most; or the columns follow its
  // tilting.
  const auto points_up = [](const auto& fit) {
    return fit && fit->error < max_attitude_error && fit->share_of_level < max_attitude_share;
  };
  const auto follows = [&](const auto& fit) { return points_up(fit) && fit->share_of_constant < max_attitude_share; };
  const bool do_most = 2 * std::ranges::count_if(fits, points_up) > std::ssize(fits) && std::ssize(fits) > 1;
  for (std::size_t s = 0; s < fits.size(); ++s)
    if (do_most ? points_up(fits[s]) : follows(fits[s]))
      return error(
          "{0}: {0}_gx, {0}_gy, {0}_gz hold Euler angles, not angular rates: their vertical follows the "
          "accelerometer's within {1:.1f}°; export what the gyroscope measures",
          recording.sensors[s].name, fits[s]->error / degree);
  return {};
}

void mend_axes(MendedLog& log, int threads) {
  const std::size_t sensors = log.log().sensors.size();
  std::vector<SensorLikelihoods> likelihoods(sensors);
  parallel_for(sensors, threads, [&](std::size_t s) {
    const InsSensor& sensor = log.log().sensors[s];
    likelihoods[s] = likelihoods_of(sensor, log.log().time(sensor));
  });
  const std::size_t common = common_unit(likelihoods);
  if (common == no_rotation) {
    std::vector<std::string> names;
    for (const InsSensor& sensor : log.log().sensors) names.push_back(sensor.name);
    log.findings.push_back(
        {.kind = FindingKind::rates_unrelated, .severity = Severity::fault, .values = {{"sensors", names}}});
    return;
  }
  std::vector<MappedSensor> mapped;
  for (std::size_t s = 0; s < sensors; ++s) {
    const std::size_t unit = unit_of(likelihoods[s], common);
    const AxisFault fault = axis_fault(likelihoods[s], unit, log.log().sensors[s].has_magnetometer());
    if (unit == 0 && fault.instrument == OddInstrument::none) continue;
    InsSensor& sensor = log.edit().sensors[s];
    if (unit != 0) {
      transform(sensor.angular_velocity, rate_units[unit], Mat3::Identity());
      add_unit_finding(log, FindingKind::rate_unit, Severity::fault, rate_units[unit], sensor.name);
    }
    if (fault.instrument != OddInstrument::none) {
      mapped.push_back({s, sensor, fault});
      transform(odd_instrument(sensor, fault.instrument), 1.0, fault.axes);
    }
    flag_faults(sensor);
  }
  ask_neighbours(log, mapped, threads);
}

}  // namespace kinfer::identify
