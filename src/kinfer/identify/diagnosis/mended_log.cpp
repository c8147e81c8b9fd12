// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/diagnosis/mended_log.hpp"

#include <cmath>

namespace kinfer::identify {

void add_unit_finding(MendedLog& log, FindingKind kind, Severity severity, double unit, const std::string& sensor) {
  for (Finding& f : log.findings)
    if (f.kind == kind && std::abs(f.values.number("unit") / unit - 1.0) < 1e-9) {
      auto sensors = f.values.texts("sensors");
      sensors.push_back(sensor);
      return f.values.set("sensors", std::move(sensors));
    }
  log.findings.push_back({.kind = kind,
                          .severity = severity,
                          .values = {{"sensors", std::vector<std::string>{sensor}}, {"unit", unit}},
                          .applied = true});
}

void transform(TriadColumns& triad, double factor, const Mat3& axes) {
  for (std::size_t row = 0; row < triad.axis[0].size(); ++row) {
    const Vec3 v = factor * axes * triad.at(row);
    for (std::size_t k = 0; k < 3; ++k) triad.axis[k][row] = static_cast<float>(v[static_cast<Eigen::Index>(k)]);
  }
}

}  // namespace kinfer::identify
