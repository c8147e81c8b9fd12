// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/diagnosis/diagnosis.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/identify/diagnosis/axes.hpp"
#include "kinfer/identify/diagnosis/common_scales.hpp"
#include "kinfer/identify/diagnosis/copied_rows.hpp"
#include "kinfer/identify/diagnosis/lags.hpp"
#include "kinfer/identify/diagnosis/rows.hpp"
#include "kinfer/identify/diagnosis/signs.hpp"
#include "kinfer/identify/diagnosis/thresholds.hpp"
#include "kinfer/identify/diagnosis/units.hpp"
#include "kinfer/identify/screening/duplicates.hpp"

namespace kinfer::identify {
namespace {

/// [rad/s] rms of the rates about their mean; NaN samples do not count.
double rate_scatter(const InsSensor& sensor) {
  Vec3 sum = Vec3::Zero();
  double square = 0.0, n = 0.0;
  for (std::size_t row = 0; row < sensor.angular_velocity.axis[0].size(); ++row)
    if (const Vec3 w = sensor.angular_velocity.at(row); w.allFinite()) sum += w, square += w.squaredNorm(), n += 1.0;
  return n > 0.0 ? std::sqrt(std::max(square / n - (sum / n).squaredNorm(), 0.0)) : 0.0;
}

/// Among sensors that move: at rest, two with coarse digits may read the same.
std::vector<Finding> duplicates_of(const InsRecording& recording) {
  std::vector<std::size_t> moving;
  for (std::size_t s = 0; s < recording.sensors.size(); ++s)
    if (rate_scatter(recording.sensors[s]) > min_duplicate_rate) moving.push_back(s);
  return duplicate_findings(recording, moving);
}

/// Sensors of which nothing was said about their axes, and that did not take part in an earlier question.
std::vector<std::size_t> not_yet_mapped(const LogDiagnosis& diagnosis, const InsRecording& recording,
                                        const std::vector<std::size_t>& sensors) {
  std::vector<std::size_t> result;
  for (const std::size_t s : sensors)
    if (std::ranges::none_of(diagnosis.findings, [&](const Finding& f) {
          return f.values.has("axes") && f.values.text("sensor") == recording.sensors[s].name;
        }))
      result.push_back(s);
  return result;
}

}  // namespace

bool mend_unconnected_axes(LogDiagnosis& diagnosis, const InsRecording& recording, const InsRecording& used,
                           const std::vector<std::size_t>& unconnected, int threads) {
  const auto asked = not_yet_mapped(diagnosis, used, unconnected);
  if (asked.empty() || asked.size() > most_asked_sensors) return false;
  const auto wanted = axes_wanted_by_neighbours(used, asked, threads);
  if (!wanted) return false;
  if (!diagnosis.mended) diagnosis.mended = recording;
  map_axes(*diagnosis.mended, *wanted);
  diagnosis.findings.push_back(wanted->finding);
  return true;
}

Result<LogDiagnosis> diagnose_log(const InsRecording& recording, int threads) {
  if (const auto rows = refuse_copied_rows(recording); !rows) return forward_error(rows.error());
  MendedLog log(recording);
  log.findings = duplicates_of(recording);
  if (const auto forces = mend_forces(log); !forces) return forward_error(forces.error());
  mend_clocks(log, threads);
  mend_fields(log);
  if (const auto rates = refuse_attitudes(log.log()); !rates) return forward_error(rates.error());
  mend_rows(log, threads);
  mend_axes(log, threads);
  mend_signs(log, threads);
  mend_common_scales(log, threads);
  mend_lags(log, threads);
  LogDiagnosis diagnosis{.mended = std::nullopt, .findings = std::move(log.findings), .scales = log.scales};
  diagnosis.mended = log.take();
  return diagnosis;
}

}  // namespace kinfer::identify
