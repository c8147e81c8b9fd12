// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/toml/instrument_toml.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kinfer {
namespace {

double non_negative_or_zero(TableReader& reader, std::string_view key) {
  const double value = reader.number_or(key, 0.0);
  if (value < 0) reader.report_error(reader.line_of(key), fmt::format("\"{}\": expected a number from 0", key));
  return value;
}

/// Of an instrument whose `sigma` is not stated: the larger of those of its wires, bars and contacts.
std::optional<double> stated_length_sigma(const Instrument& instrument) {
  if (!instrument.sigma_distance && !instrument.sigma_contact) return std::nullopt;
  return std::max(instrument.sigma_distance.value_or(0.0), instrument.sigma_contact.value_or(0.0));
}

bool states_any_accuracy(const Instrument& instrument) {
  return instrument.states_lengths() || instrument.sigma_angle > 0.0 ||
         std::ranges::any_of(instrument_sigmas,
                             [&](const InstrumentSigma& s) { return (instrument.*s.value).has_value(); });
}

/// Of a stated accuracy: zero means noise-free and not that it is unknown.
double noise_free_at_zero(double sigma) {
  constexpr double noise_free = 1e-9;  // [m], [rad], [m/s²]
  return std::max(sigma, noise_free);
}

}  // namespace

Tolerances read_tolerances(TableReader& file, const Scales& scales, FirstError& first_error) {
  Tolerances tolerances;
  const TomlTable* table = file.table_or_none("tolerance");
  if (!table) return tolerances;
  TableReader reader(*table, file.line_of("tolerance"), "tolerance: ", first_error);
  const auto read = [&](std::string_view key, double& value, double scale) {
    value = reader.positive_or(key, value / scale) * scale;
  };
  read("length", tolerances.length, scales.length);
  read("angle", tolerances.angle, scales.angle);
  read("base_length", tolerances.base_length, scales.length);
  read("base_angle", tolerances.base_angle, scales.angle);
  read("tool_length", tolerances.tool_length, scales.length);
  read("tool_angle", tolerances.tool_angle, scales.angle);
  read("gain", tolerances.gain, 1.0);
  read("compliance", tolerances.compliance, 1.0);
  read("anchor", tolerances.anchor, scales.length);
  reader.expect_no_other_keys();
  return tolerances;
}

std::optional<Instrument> read_instrument(TableReader& file, const Scales& scales, std::optional<Vec3>& at,
                                          FirstError& first_error) {
  const TomlTable* table = file.table_or_none("instrument");
  if (!table) return std::nullopt;
  TableReader reader(*table, file.line_of("instrument"), "instrument: ", first_error);
  reader.text_or("kind", "position");
  Instrument instrument;
  const double length = non_negative_or_zero(reader, "sigma") * scales.length,
               angle = non_negative_or_zero(reader, "sigma_angle") * scales.angle;
  if (reader.has("sigma_angle")) instrument.sigma_angle = noise_free_at_zero(angle);
  instrument.ppm = non_negative_or_zero(reader, "ppm");
  for (const InstrumentSigma& sigma : instrument_sigmas) {
    const double value = non_negative_or_zero(reader, sigma.key) * scales.of(sigma.unit);
    if (reader.has(sigma.key)) instrument.*sigma.value = noise_free_at_zero(value);
  }
  if (reader.has("at")) at = reader.vector("at") * scales.length;
  reader.expect_no_other_keys();
  instrument.sigma = reader.has("sigma") ? noise_free_at_zero(length) : stated_length_sigma(instrument).value_or(0.0);
  if (!states_any_accuracy(instrument)) return std::nullopt;
  return instrument;
}

}  // namespace kinfer
