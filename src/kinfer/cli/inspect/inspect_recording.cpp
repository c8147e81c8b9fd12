// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/inspect/inspect_recording.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/constants.hpp"
#include "kinfer/cli/inspect/recording_json.hpp"
#include "kinfer/cli/parts/common.hpp"
#include "kinfer/cli/parts/ins_logs.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/inertial/activity.hpp"
#include "kinfer/inertial/allan.hpp"
#include "kinfer/inertial/sensor_grading.hpp"
#include "kinfer/words/findings/findings.hpp"

namespace kinfer::cli {
namespace {

constexpr double micro_g = 1e-6 * standard_gravity;  // [m/s²]

void print_loggers(const InsRecording& recording) {
  for (const InsLogger& logger : recording.loggers) {
    const double period = sample_period(logger.time), span = logger.time.back() - logger.time.front();
    print_text("{}: {} rows, {:.3f} s to {:.3f} s", logger.name, logger.time.size(), logger.time.front(),
               logger.time.back());
    if (period > 0.0) print_text(", {:.4g} Hz", 1.0 / period);
    if (span > 0.0)
      print_text(" ({:.2f} % of it is there)", 100.0 * static_cast<double>(logger.time.size() - 1) * period / span);
    print_text("\n");
    const auto found = gaps(logger.time);
    for (std::size_t i = 0; i < std::min<std::size_t>(found.size(), 5); ++i)
      print_text("  gap {:.3f} s to {:.3f} s\n", found[i].begin, found[i].end);
    if (found.size() > 5) print_text("  ... {} gaps in all\n", found.size());
  }
}

std::string triple(const Vec3& v, double unit, const char* format_of) {
  return fmt::format(fmt::runtime(format_of), v.x() / unit, v.y() / unit, v.z() / unit);
}

/// The Earth's field is 25 to 65 µT; other magnitudes are of an arbitrary unit, as the header may state.
bool is_in_microtesla(const InsSensor& sensor) {
  double sum = 0.0, n = 0.0;
  for (std::size_t row = 0; row < sensor.rows(); ++row)
    if (!(sensor.faults[row] & field_missing)) sum += sensor.field.at(row).norm(), n += 1.0;
  return n > 0.0 && sum / n > 15.0 && sum / n < 150.0;
}

void print_sensor(const InsSensor& sensor, std::span<const double> time, const std::vector<RestPeriod>& rest_list) {
  print_text("\n{}: accelerometer {:.4g} Hz, gyroscope {:.4g} Hz, ", sensor.name,
             sample_rate(sensor, time, acceleration_missing), sample_rate(sensor, time, angular_velocity_missing));
  if (sensor.has_magnetometer())
    print_text("magnetometer {:.4g} Hz\n", sample_rate(sensor, time, field_missing));
  else
    print_text("no magnetometer in use\n");
  if (rest_list.empty()) {
    print_text("  ! no rest found: let the sensor stand still for a few seconds before and after the motion\n");
    return;
  }
  const SensorStatistics found = sensor_statistics(sensor, time, rest_list);
  print_text("  {} rests, {:.1f} s in all:", rest_list.size(), found.rest_seconds);
  for (std::size_t i = 0; i < std::min<std::size_t>(rest_list.size(), 4); ++i)
    print_text(" {:.1f}-{:.1f}", rest_list[i].begin, rest_list[i].end);
  print_text("{} s\n", rest_list.size() > 4 ? " ..." : "");
  print_text("  gyro bias at rest {} °/s, spread over the rests {} °/s\n",
             triple(found.gyroscope_bias.mean, degree, "{:.4f} {:.4f} {:.4f}"),
             triple(found.gyroscope_bias.spread, degree, "{:.4f} {:.4f} {:.4f}"));
  print_text("  noise at rest: gyro {} °/s/√Hz, accelerometer {} µg/√Hz",
             triple(found.rate_density, degree, "{:.4f} {:.4f} {:.4f}"),
             triple(found.acceleration_density, micro_g, "{:.0f} {:.0f} {:.0f}"));
  if (sensor.has_magnetometer())
    print_text(", field {} {}/√Hz", triple(found.field_density, 1.0, "{:.3f} {:.3f} {:.3f}"),
               is_in_microtesla(sensor) ? "µT" : "of its unit");
  print_text(
      "\n  gravity at rest is {:.3f} m/s² off; largest values {:.0f} °/s and {:.1f} m/s²; gyro scale errors about "
      "{:.2g} %\n",
      found.gravity_error, found.largest_rate / degree, found.largest_acceleration, 100.0 * found.scale_error);
  print_text("  judged grade: {}\n", estimate_sensor_model(found).name);
}

void print_activity(const InsRecording& recording) {
  if (recording.loggers.size() != 1 || recording.sensors.size() < 2) return;
  print_text("\nwho moves when (s; number: rms rate in °/s, - still):\n  {:>16}", "");
  for (const InsSensor& sensor : recording.sensors) print_text(" {:>8}", sensor.name.substr(0, 8));
  print_text("\n");
  for (const ActivitySpan& span : detect_activity(recording)) {
    print_text("  {:>7.1f} {:>8.1f}", span.begin, span.end);
    for (const SensorActivity& s : span.sensors)
      s.moves ? print_text(" {:>8.2f}", s.rms_rate / degree) : print_text(" {:>8}", "-");
    print_text("\n");
  }
}

/// Whether the sign of all accelerometers together is known, which only magnetometers tell.
void print_sign(const InsRecording& recording) {
  if (assumes_upward_force(recording))
    print_text(
        "  assumed: accelerometers read +g upwards at rest; without magnetometer nothing in the log tells, and if they "
        "read -g all lever arms come out mirrored\n");
}

void print_findings(const InsRecording& recording, const std::vector<Finding>& findings) {
  print_text("\ndiagnosis:\n");
  if (findings.empty())
    print_text("  nothing wrong was found: units, signs, axes and times of the instruments agree\n");
  for (const Finding& f : findings) {
    print_text("  {}: {}\n", name(f.severity), words::sentence(f));
    if (const std::string remedy = words::suggestion(f); !remedy.empty()) print_text("    -> {}\n", remedy);
  }
  print_sign(recording);
}

/// Values of one axis over the rows of a rest; missing values are skipped, which is harmless at rest.
std::vector<double> values_at_rest(const std::vector<float>& axis, const RestPeriod& rest) {
  std::vector<double> values;
  for (std::size_t row = rest.first_row; row <= rest.last_row; ++row)
    if (std::isfinite(axis[row])) values.push_back(axis[row]);
  return values;
}

void print_allan_of(const char* what, const TriadColumns& triad, const RestPeriod& rest, double period, double unit,
                    const char* unit_name) {
  print_text("  {} [{}]: averaging time, then x y z\n", what, unit_name);
  std::array<std::vector<AllanPoint>, 3> curves;
  for (std::size_t axis = 0; axis < 3; ++axis)
    curves[axis] = allan_deviation(values_at_rest(triad.axis[axis], rest), period);
  for (std::size_t i = 0; i < curves[0].size() && i < curves[1].size() && i < curves[2].size(); ++i)
    print_text("    {:>10.4f} s {:>10.5f} {:>10.5f} {:>10.5f}\n", curves[0][i].tau, curves[0][i].deviation / unit,
               curves[1][i].deviation / unit, curves[2][i].deviation / unit);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const AllanCoefficients f = allan_coefficients(curves[axis]);
    print_text("    {}: noise density {:.5f} {}/√Hz, bias instability {} {:.5f} {} (at {:.1f} s)\n", "xyz"[axis],
               f.noise_density / unit, unit_name, f.reaches_floor ? "" : "below", f.bias_instability / unit, unit_name,
               f.instability_tau);
  }
}

void print_allan(const InsRecording& recording) {
  for (const InsSensor& sensor : recording.sensors) {
    const auto time = recording.time(sensor);
    const auto rest_list = rest_periods(sensor, time);
    if (rest_list.empty()) {
      print_text("\nAllan deviation of {}: no rest to take it from\n", sensor.name);
      continue;
    }
    const RestPeriod& longest =
        *std::ranges::max_element(rest_list, {}, [](const RestPeriod& r) { return r.seconds(); });
    print_text("\nAllan deviation of {} over its longest rest, {:.1f} s to {:.1f} s\n", sensor.name, longest.begin,
               longest.end);
    const double period = longest.seconds() / static_cast<double>(longest.last_row - longest.first_row);
    print_allan_of("angular rate", sensor.angular_velocity, longest, period, degree, "°/s");
    print_allan_of("specific force", sensor.acceleration, longest, period, 1e-3 * standard_gravity, "mg");
    if (longest.seconds() < 600.0)
      print_text("  (bias instability needs an hour of rest; this one shows the noise only)\n");
  }
}

}  // namespace

int inspect_recording(const RecordingChoice& choice, AllanPlot allan, InspectOutput output) {
  const auto logs = read_diagnosed_logs({choice.paths, choice.columns, choice.topics}, CommonOptions{});
  if (!logs) return fail(logs.error());
  if (output == InspectOutput::json) {
    print_data(recording_json(*logs));
    return exit_done;
  }
  const InsRecording* recording = &logs->recording;
  print_loggers(*recording);
  for (const InsSensor& sensor : recording->sensors) {
    const auto time = recording->time(sensor);
    print_sensor(sensor, time, rest_periods(sensor, time));
  }
  print_activity(*recording);
  if (!recording->remarks.empty()) print_text("\n");
  for (const std::string& remark : recording->remarks) print_text("! {}\n", remark);
  print_findings(*recording, logs->findings);
  if (allan == AllanPlot::print) print_allan(*recording);
  return exit_done;
}

}  // namespace kinfer::cli
