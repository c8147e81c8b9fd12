// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/ins_recording.hpp"

#include <cmath>
#include <numbers>

#include "kinfer/measurement/ins/ins_screening.hpp"
#include "kinfer/simulate/magnetic_faults.hpp"

namespace kinfer {
namespace {

constexpr double disturbance_time = 2.0;      // [s]
constexpr double mean_run = 5.0;              // rows per loss
constexpr double largest_force_spike = 80.0;  // [m/s²]
constexpr double largest_rate_spike = 10.0;   // [rad/s]

enum Stream : std::uint64_t { accelerometer = 1, gyroscope, magnetometer, losses, steel, iron, transients };
constexpr std::uint64_t other_drives = 1U << 30U;  // a stream beyond those of the sensors

/// Draws of what belongs to the sensors, and of what is new in each drive.
struct Draws {
  Rng sensors, drive;

  Draws stream(std::uint64_t index) const { return {sensors.stream(index), drive.stream(index)}; }
};

/// Random spikes of a three-axis instrument.
class Spikes {
 public:
  Spikes(double per_minute, double step, double largest, Rng rng)
      : chance_(per_minute * step / 60.0), largest_(largest), rng_(rng) {}

  Vec3 next() {
    Vec3 spike = Vec3::Zero();
    for (double& s : spike)
      if (chance_ > 0.0 && rng_.uniform() < chance_) {
        const double size = rng_.uniform(0.5, 1.0) * largest_;
        s = rng_.index(2) == 0 ? -size : size;
      }
    return spike;
  }

 private:
  double chance_, largest_;
  Rng rng_;
};

TriadColumns simulate_columns(const std::vector<Vec3>& truth, const InstrumentModel& model, double step, Spikes spikes,
                              const Draws& rng) {
  SimulatedInstrument instrument(model, sample_instrument_errors(model, rng.sensors.stream(1)), rng.drive.stream(2));
  TriadColumns columns;
  for (auto& axis : columns.axis) axis.reserve(truth.size());
  for (const Vec3& t : truth) {
    const Vec3 measured =
        instrument.read(t + spikes.next(), step);  // added before the instrument, whose range clips spikes too
    for (int i = 0; i < 3; ++i) columns.axis[i].push_back(static_cast<float>(measured[i]));
  }
  return columns;
}

/// Adds the field of moving steel: a Gauss-Markov process behind a first-order lag of the same time constant, so that
/// it is smooth; the lag halves the variance.
std::vector<Vec3> add_disturbance(std::vector<Vec3> field, double rms, double step, Rng rng) {
  InstrumentModel wandering;
  wandering.instability = std::numbers::sqrt2 * rms;
  wandering.instability_time = disturbance_time;
  SimulatedInstrument process(wandering, {}, rng);
  const double follow = 1.0 - std::exp(-step / disturbance_time);
  Vec3 smooth = Vec3::Zero();
  for (Vec3& f : field) {
    smooth += follow * (process.read(Vec3::Zero(), step) - smooth);
    f += smooth;
  }
  return field;
}

/// Two-state Markov chain, kept and lost, with transition probabilities from lost fraction and mean length of a loss.
void drop_rows(InsSensor& sensor, double fraction, Rng rng) {
  const double begin = fraction / (mean_run * (1.0 - fraction)), end = 1.0 / mean_run;
  bool lost = false;
  for (std::size_t row = 0; row < sensor.acceleration.axis[0].size(); ++row) {
    lost = rng.uniform() < (lost ? 1.0 - end : begin);
    if (!lost) continue;
    for (TriadColumns* columns : {&sensor.acceleration, &sensor.angular_velocity, &sensor.field})
      for (auto& axis : columns->axis)
        if (!axis.empty()) axis[row] = std::numeric_limits<float>::quiet_NaN();
  }
}

/// The field at a sensor with everything that disturbs it.
std::vector<Vec3> disturbed_field(const SensorMotion& truth, const SensorFaults& sensor_faults, bool has_transients,
                                  double step, const Draws& rng) {
  std::vector<Vec3> field =
      add_disturbance(truth.field, sensor_faults.magnetic_disturbance, step, rng.drive.stream(steel));
  if (has_transients)
    field = with_transients(std::move(field), sensor_faults.magnetic_transients, step, rng.drive.stream(transients));
  return with_iron(std::move(field), sensor_faults.hard_iron, sensor_faults.soft_iron, rng.sensors.stream(iron));
}

InsSensor simulate_sensor(const SensorMotion& truth, const SensorModel& model, const SensorFaults& sensor_faults,
                          bool has_transients, double step, const Draws& rng) {
  InsSensor sensor;
  const Spikes of_force(sensor_faults.spikes, step, largest_force_spike, rng.drive.stream(accelerometer).stream(3));
  const Spikes of_rate(sensor_faults.spikes, step, largest_rate_spike, rng.drive.stream(gyroscope).stream(3));
  sensor.acceleration = simulate_columns(truth.force, model.accelerometer, step, of_force, rng.stream(accelerometer));
  sensor.angular_velocity =
      simulate_columns(truth.angular_velocity, model.gyroscope, step, of_rate, rng.stream(gyroscope));
  if (sensor_faults.has_magnetometer) {
    const std::vector<Vec3> field = disturbed_field(truth, sensor_faults, has_transients, step, rng);
    const Spikes none(0.0, step, 0.0, rng.drive);
    sensor.field = simulate_columns(field, model.magnetometer, step, none, rng.stream(magnetometer));
  }
  if (sensor_faults.missing > 0.0) drop_rows(sensor, sensor_faults.missing, rng.drive.stream(losses));
  flag_faults(sensor);
  return sensor;
}

/// Two sensors at random beside which steel passes; none where nothing does.
std::vector<bool> sensors_with_transients(std::size_t count, const SensorFaults& sensor_faults, Rng rng) {
  std::vector<bool> has_transients(count, false);
  if (!(sensor_faults.magnetic_transients > 0.0)) return has_transients;
  for (std::size_t left = std::min<std::size_t>(2, count); left > 0;) {
    const auto at = static_cast<std::size_t>(rng.index(count));
    if (has_transients[at]) continue;
    has_transients[at] = true;
    --left;
  }
  return has_transients;
}

}  // namespace

InsRecording simulate_recording(const Machine& machine, const MachineMotion& motion, const SensorModel& model,
                                const SensorFaults& sensor_faults, const Rng& rng, std::uint64_t drive) {
  const Draws draws{rng, drive <= 1 ? rng : rng.stream(other_drives).stream(drive)};
  InsRecording recording;
  recording.loggers.push_back({"imu.csv", motion.time});
  const double step = median_period(motion.time);
  const auto has_transients =
      sensors_with_transients(machine.sensors.size(), sensor_faults, draws.drive.stream(transients));
  for (std::size_t s = 0; s < machine.sensors.size(); ++s) {
    recording.sensors.push_back(
        simulate_sensor(motion.sensors[s], model, sensor_faults, has_transients[s], step, draws.stream(s)));
    recording.sensors.back().name = machine.sensors[s].name;
  }
  return recording;
}

}  // namespace kinfer
