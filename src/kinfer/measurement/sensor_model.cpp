// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/sensor_model.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/constants.hpp"
#include "kinfer/geometry/random.hpp"

namespace kinfer {
namespace {

constexpr double g = standard_gravity;
constexpr double micro_g = 1e-6 * g, milli_g = 1e-3 * g;
constexpr double degree_per_hour = degree / 3600.0;

SensorModel noise_grade() {
  return {.name = "noise",
          .accelerometer = {.noise_density = 120 * micro_g, .range = 16 * g},
          .gyroscope = {.noise_density = 0.007 * degree, .range = 2000 * degree},
          .magnetometer = {.noise_density = 0.02}};
}

SensorModel industrial_grade() {
  return {.name = "industrial",
          .accelerometer = {.noise_density = 120 * micro_g,
                            .bias_sd = 1 * milli_g,
                            .instability = 0.03 * milli_g,
                            .scale_sd = 3e-4,
                            .range = 16 * g,
                            .resolution = g / 16384},
          .gyroscope = {.noise_density = 0.007 * degree,
                        .bias_sd = 0.2 * degree,
                        .instability = 10 * degree_per_hour,
                        .scale_sd = 5e-4,
                        .range = 2000 * degree,
                        .resolution = degree / 65.5},
          .magnetometer = {
              .noise_density = 0.02, .bias_sd = 0.3, .instability = 0.01, .scale_sd = 2e-3, .resolution = 0.15}};
}

SensorModel consumer_grade() {
  return {
      .name = "consumer",
      .accelerometer = {.noise_density = 300 * micro_g,
                        .bias_sd = 20 * milli_g,
                        .instability = 0.1 * milli_g,
                        .scale_sd = 5e-3,
                        .range = 8 * g,
                        .resolution = g / 4096},
      .gyroscope = {.noise_density = 0.02 * degree,
                    .bias_sd = 1 * degree,
                    .instability = 30 * degree_per_hour,
                    .scale_sd = 5e-3,
                    .range = 500 * degree,
                    .resolution = degree / 65.5},
      .magnetometer = {.noise_density = 0.05, .bias_sd = 1, .instability = 0.05, .scale_sd = 1e-2, .resolution = 0.3}};
}

}  // namespace

std::optional<SensorModel> sensor_grade(std::string_view name) {
  if (name == "noise") return noise_grade();
  if (name == "industrial") return industrial_grade();
  if (name == "consumer") return consumer_grade();
  return std::nullopt;
}

InstrumentErrors sample_instrument_errors(const InstrumentModel& model, Rng rng) {
  InstrumentErrors errors;
  for (int i = 0; i < 3; ++i) errors.bias[i] = model.bias_sd * rng.normal();
  for (int i = 0; i < 9; ++i) errors.matrix(i / 3, i % 3) += model.scale_sd * rng.normal();
  return errors;
}

SimulatedInstrument::SimulatedInstrument(const InstrumentModel& model, const InstrumentErrors& errors, Rng rng)
    : model_(model), errors_(errors), rng_(rng) {
  bias_instability_ = model_.instability * draw_normals();
}

Vec3 SimulatedInstrument::draw_normals() {
  return normal_vector(rng_);
}

Vec3 SimulatedInstrument::read(const Vec3& truth, double dt) {
  const double keep = std::exp(-dt / model_.instability_time);
  bias_instability_ = keep * bias_instability_ + model_.instability * std::sqrt(1.0 - keep * keep) * draw_normals();
  Vec3 reading = errors_.matrix * truth + errors_.bias + bias_instability_ +
                 model_.noise_density / std::sqrt(2.0 * dt) * draw_normals();
  for (double& value : reading) {
    if (model_.resolution > 0.0) value = model_.resolution * std::round(value / model_.resolution);
    value = std::clamp(value, -model_.range, model_.range);
  }
  return reading;
}

}  // namespace kinfer
