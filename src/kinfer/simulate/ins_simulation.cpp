#include "kinfer/simulate/ins_simulation.hpp"

#include <cmath>
#include <numbers>

#include "kinfer/measurement/ins_screening.hpp"

namespace kinfer {
namespace {

constexpr double disturbance_time = 2.0;      // [s]
constexpr double mean_run = 5.0;              // rows of a loss
constexpr double largest_force_spike = 80.0;  // [m/s²]
constexpr double largest_rate_spike = 10.0;   // [rad/s]

enum Stream : std::uint64_t { accelerometer = 1, gyroscope, magnetometer, losses, steel };

/// Wild samples of a three-axis instrument.
class Spikes {
 public:
  Spikes(double per_minute, double step, double largest, Rng rng)
      : chance_(per_minute * step / 60.0), largest_(largest), rng_(rng) {}

  Vec3 next() {
    Vec3 spike = Vec3::Zero();
    for (double& s : spike)
      if (chance_ > 0.0 && rng_.uniform() < chance_)
        s = (rng_.index(2) == 0 ? -1.0 : 1.0) * rng_.uniform(0.5, 1.0) * largest_;
    return spike;
  }

 private:
  double chance_, largest_;
  Rng rng_;
};

TriadColumns readings(const std::vector<Vec3>& truth, const InstrumentModel& model, double step, Spikes spikes,
                      Rng rng) {
  SimulatedInstrument instrument(model, drawn_errors(model, rng.stream(1)), rng.stream(2));
  TriadColumns columns;
  for (auto& axis : columns.axis) axis.reserve(truth.size());
  for (const Vec3& t : truth) {
    const Vec3 reading =
        instrument.read(t + spikes.next(), step);  // before the instrument, whose range holds for spikes too
    for (int i = 0; i < 3; ++i) columns.axis[i].push_back(static_cast<float>(reading[i]));
  }
  return columns;
}

/// The field with that of moving steel added: a Gauss-Markov process behind a first-order lag of the same time
/// constant, so that it is smooth; the lag leaves half the variance.
std::vector<Vec3> disturbed(std::vector<Vec3> field, double rms, double step, Rng rng) {
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

/// Two states, kept and lost, with the chances that give the fraction and the mean length of a loss.
void lose_rows(InsSensor& sensor, double fraction, Rng rng) {
  const double begin = fraction / (mean_run * (1.0 - fraction)), end = 1.0 / mean_run;
  bool lost = false;
  for (std::size_t row = 0; row < sensor.acceleration.axis[0].size(); ++row) {
    lost = rng.uniform() < (lost ? 1.0 - end : begin);
    if (!lost) continue;
    for (TriadColumns* columns : {&sensor.acceleration, &sensor.rate, &sensor.field})
      for (auto& axis : columns->axis)
        if (!axis.empty()) axis[row] = std::numeric_limits<float>::quiet_NaN();
  }
}

InsSensor simulated_sensor(const SensorMotion& truth, const SensorModel& model, const SensorTrouble& trouble,
                           double step, Rng rng) {
  InsSensor sensor;
  const Spikes of_force(trouble.spikes, step, largest_force_spike, rng.stream(accelerometer).stream(3));
  const Spikes of_rate(trouble.spikes, step, largest_rate_spike, rng.stream(gyroscope).stream(3));
  sensor.acceleration = readings(truth.force, model.accelerometer, step, of_force, rng.stream(accelerometer));
  sensor.rate = readings(truth.rate, model.gyroscope, step, of_rate, rng.stream(gyroscope));
  if (trouble.has_magnetometer)
    sensor.field = readings(disturbed(truth.field, trouble.magnetic_disturbance, step, rng.stream(steel)),
                            model.magnetometer, step, Spikes(0.0, step, 0.0, rng), rng.stream(magnetometer));
  if (trouble.missing > 0.0) lose_rows(sensor, trouble.missing, rng.stream(losses));
  mark_faults(sensor);
  return sensor;
}

}  // namespace

InsRecording simulated_recording(const Machine& machine, const MachineMotion& motion, const SensorModel& model,
                                 const SensorTrouble& trouble, Rng rng) {
  InsRecording recording;
  recording.loggers.push_back({"imu.csv", motion.time});
  const double step = typical_period(motion.time);
  for (std::size_t s = 0; s < machine.sensors.size(); ++s) {
    recording.sensors.push_back(simulated_sensor(motion.sensors[s], model, trouble, step, rng.stream(s)));
    recording.sensors.back().name = machine.sensors[s].name;
  }
  return recording;
}

}  // namespace kinfer
