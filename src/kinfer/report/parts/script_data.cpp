// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/parts/script_data.hpp"

#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "kinfer/io/evidence/calibration_json.hpp"
#include "kinfer/io/evidence/identification_json.hpp"
#include "kinfer/io/text/dump_json.hpp"
#include "kinfer/report/parts/packed.hpp"

namespace kinfer::report {
namespace {

using Json = nlohmann::ordered_json;

Json members(const nlohmann::ordered_json& evidence, std::initializer_list<const char*> keys) {
  Json part;
  for (const char* key : keys) part[key] = evidence.at(key);
  return part;
}

/// Lengths rounded to 0.1 µm, sufficient for drawings and tooltips.
Json rounded_errors(const std::vector<RowErrors>& rows, double RowErrors::*error) {
  Json list = Json::array();
  for (const RowErrors& row : rows) list.push_back(std::round(row.*error * 1e7) / 1e7);
  return list;
}

Json packed_signal(const std::array<Envelope, 3>& signal) {
  Json axes = Json::array();
  for (const Envelope& envelope : signal)
    axes.push_back({{"low", packed(envelope.low)}, {"high", packed(envelope.high)}});
  return axes;
}

}  // namespace

std::string script_data(const CalibrationEvidence& evidence) {
  Json part = members(calibration_json(evidence), {"kind", "outliers", "picture"});
  Json held_out = Json::array();
  for (const RowErrors& row : evidence.rows) held_out.push_back(row.held_out);
  part["rows"] = {{"before", rounded_errors(evidence.rows, &RowErrors::before)},
                  {"after", rounded_errors(evidence.rows, &RowErrors::after)},
                  {"held_out", held_out}};
  return dump_json(part);
}

std::string script_data(const IdentificationEvidence& evidence) {
  Json part = members(identification_json(evidence), {"kind", "root", "joints", "chain", "order", "motion"});
  Json& traces = part["motion"]["traces"];
  for (std::size_t i = 0; i < evidence.motion.traces.size(); ++i) {
    const Trace& trace = evidence.motion.traces[i];
    traces[i]["measured"] = packed_signal(trace.measured);
    traces[i]["predicted"] = packed_signal(trace.predicted);
    traces[i]["residual"] = packed_signal(trace.residual);
  }
  return dump_json(part);
}

std::string escape_for_script(std::string_view json) {
  std::string safe;
  for (const char c : json) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

}  // namespace kinfer::report
