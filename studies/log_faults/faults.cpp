// SPDX-License-Identifier: Apache-2.0
#include "studies/log_faults/faults.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/constants.hpp"
#include "kinfer/identify/diagnosis/mended_log.hpp"
#include "kinfer/inertial/diagnosis/section_fit.hpp"
#include "kinfer/inertial/sensor_orientations.hpp"
#include "kinfer/measurement/ins/ins_screening.hpp"

namespace kinfer::study::log_faults_study {
namespace {

using identify::transform;

/// Any sensor but the root's.
InsSensor& some_sensor(InsRecording& recording, Rng rng) {
  return recording.sensors[1 + rng.index(recording.sensors.size() - 1)];
}

void reflag(InsRecording& recording) {
  for (InsSensor& sensor : recording.sensors) flag_faults(sensor);
}

void scale_rates(InsRecording& recording, double factor) {
  for (InsSensor& sensor : recording.sensors) transform(sensor.angular_velocity, factor, Mat3::Identity());
}

Mat3 mirror() {
  return Vec3(-1, 1, 1).asDiagonal();
}

/// A permutation of axes with signs that is a rotation, and not the identity.
Mat3 some_axes(Rng rng) {
  for (;;) {
    const Mat3& axes = signed_permutations()[1 + rng.index(47)];
    if (axes.determinant() > 0.0) return axes;
  }
}

void remove_gravity(InsRecording& recording) {
  std::vector<std::size_t> all(recording.sensors.size());
  for (std::size_t s = 0; s < all.size(); ++s) all[s] = s;
  const auto orientations = estimate_orientations(recording, all, KinferOfflineOptions{}).value();
  for (const SensorOrientations& o : orientations) {
    InsSensor& sensor = recording.sensors[o.sensor];
    for (std::size_t row = 0; row < sensor.rows(); ++row) {
      const Vec3 up = o.world_q_sensor[row].inverse() * Vec3::UnitZ();
      for (std::size_t k = 0; k < 3; ++k)
        sensor.acceleration.axis[k][row] -= static_cast<float>(standard_gravity * up[static_cast<Eigen::Index>(k)]);
    }
  }
}

void write_euler_angles(InsRecording& recording) {
  std::vector<std::size_t> all(recording.sensors.size());
  for (std::size_t s = 0; s < all.size(); ++s) all[s] = s;
  const auto orientations = estimate_orientations(recording, all, KinferOfflineOptions{}).value();
  for (const SensorOrientations& o : orientations)
    for (std::size_t row = 0; row < recording.sensors[o.sensor].rows(); ++row) {
      const Vec3 rpy = to_rpy(o.world_q_sensor[row].toRotationMatrix()) / degree;
      for (std::size_t k = 0; k < 3; ++k)
        recording.sensors[o.sensor].angular_velocity.axis[k][row] =
            static_cast<float>(rpy[static_cast<Eigen::Index>(k)]);
    }
}

/// Sample k of the result is that of k − rows, or a mean of the last 2 rows + 1.
TriadColumns delayed(const TriadColumns& triad, std::size_t rows, bool by_filter) {
  TriadColumns result = triad;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t k = 0; k < triad.axis[axis].size(); ++k) {
      double sum = 0.0, n = 0.0;
      for (std::size_t back = by_filter ? 0 : rows; back <= (by_filter ? 2 * rows : rows) && back <= k; ++back)
        sum += static_cast<double>(triad.axis[axis][k - back]), n += 1.0;
      result.axis[axis][k] = n > 0.0 ? static_cast<float>(sum / n) : std::numeric_limits<float>::quiet_NaN();
    }
  return result;
}

/// Every second row repeats the one before, or is the mean of its neighbours.
void resample(InsRecording& recording, bool linearly) {
  for (InsSensor& sensor : recording.sensors)
    for (TriadColumns* triad : {&sensor.acceleration, &sensor.angular_velocity, &sensor.field})
      for (auto& axis : triad->axis)
        for (std::size_t k = 1; k + 1 < axis.size(); k += 2)
          axis[k] = linearly ? 0.5F * (axis[k - 1] + axis[k + 1]) : axis[k - 1];
}

void negate(TriadColumns& triad) {
  transform(triad, -1.0, Mat3::Identity());
}

}  // namespace

const std::vector<LogFault>& log_faults() {
  using Kind = FindingKind;
  static const std::vector<LogFault> faults{
      {"rates in deg/s", {Kind::rate_unit}, [](InsRecording& r, Rng) { scale_rates(r, 1.0 / degree); }},
      {"one sensor's rates in deg/s",
       {Kind::rate_unit},
       [](InsRecording& r, Rng rng) {
         transform(some_sensor(r, rng).angular_velocity, 1.0 / degree, Mat3::Identity());
       }},
      {"forces in g",
       {Kind::force_unit},
       [](InsRecording& r, Rng) {
         for (InsSensor& s : r.sensors) transform(s.acceleration, 1.0 / standard_gravity, Mat3::Identity());
       }},
      {"field in mT",
       {Kind::field_unit},
       [](InsRecording& r, Rng) {
         for (InsSensor& s : r.sensors) transform(s.field, 1e-3, Mat3::Identity());
       }},
      {"times in ms",
       {Kind::clock_unit},
       [](InsRecording& r, Rng) {
         for (double& t : r.loggers[0].time) t *= 1e3;
       }},
      {"clock counts rows",
       {Kind::clock_counts},
       [](InsRecording& r, Rng) {
         for (std::size_t k = 0; k < r.loggers[0].time.size(); ++k) r.loggers[0].time[k] = static_cast<double>(k);
       }},
      {"all accelerometers negated",
       {Kind::force_sign},
       [](InsRecording& r, Rng) {
         for (InsSensor& s : r.sensors) negate(s.acceleration);
       }},
      {"one accelerometer negated",
       {Kind::force_sign},
       [](InsRecording& r, Rng rng) { negate(some_sensor(r, rng).acceleration); }},
      {"one gyroscope negated",
       {Kind::rate_sign},
       [](InsRecording& r, Rng rng) { negate(some_sensor(r, rng).angular_velocity); }},
      {"all gyroscopes negated",
       {Kind::rate_sign},
       [](InsRecording& r, Rng) {
         for (InsSensor& s : r.sensors) negate(s.angular_velocity);
       }},
      {"one sensor left-handed",
       {Kind::left_handed},
       [](InsRecording& r, Rng rng) {
         InsSensor& s = some_sensor(r, rng);
         for (TriadColumns* triad : {&s.acceleration, &s.angular_velocity, &s.field}) transform(*triad, 1.0, mirror());
       }},
      {"axes of one gyroscope swapped",
       {Kind::instrument_axes},
       [](InsRecording& r, Rng rng) {
         transform(some_sensor(r, rng.stream(1)).angular_velocity, 1.0, some_axes(rng.stream(2)));
       }},
      {"axes of one accelerometer swapped",
       {Kind::instrument_axes},
       [](InsRecording& r, Rng rng) {
         transform(some_sensor(r, rng.stream(1)).acceleration, 1.0, some_axes(rng.stream(2)));
       }},
      {"gravity removed", {}, [](InsRecording& r, Rng) { remove_gravity(r); }},
      {"Euler angles for rates", {}, [](InsRecording& r, Rng) { write_euler_angles(r); }},
      {"one sensor twice",
       {Kind::duplicate_sensor},
       [](InsRecording& r, Rng rng) {
         InsSensor& sensor = some_sensor(r, rng);
         const std::string name = sensor.name;
         sensor = r.sensors[&sensor == &r.sensors[1] ? 2 : 1];
         sensor.name = name;
       }},
      {"accelerometer 40 ms late",
       {Kind::instruments_out_of_step},
       [](InsRecording& r, Rng rng) {
         InsSensor& s = some_sensor(r, rng);
         s.acceleration = delayed(s.acceleration, 4, false);
       }},
      {"gyroscope filtered, 40 ms late",
       {Kind::instruments_out_of_step},
       [](InsRecording& r, Rng rng) {
         InsSensor& s = some_sensor(r, rng);
         s.angular_velocity = delayed(s.angular_velocity, 4, true);
       }},
      {"rows repeated", {Kind::repeated_rows}, [](InsRecording& r, Rng) { resample(r, false); }},
      {"rows interpolated", {Kind::interpolated_rows}, [](InsRecording& r, Rng) { resample(r, true); }},
  };
  static const std::vector<LogFault> flagged = [] {
    std::vector<LogFault> list = faults;
    for (LogFault& fault : list)
      fault.inject = [inject = fault.inject](InsRecording& recording, Rng rng) {
        inject(recording, rng);
        reflag(recording);
      };
    return list;
  }();
  return flagged;
}

}  // namespace kinfer::study::log_faults_study
