// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/diagnosis/rows.hpp"

#include <array>
#include <limits>

#include "kinfer/base/parallel.hpp"
#include "kinfer/identify/diagnosis/thresholds.hpp"
#include "kinfer/inertial/diagnosis/repeated_rows.hpp"
#include "kinfer/measurement/ins/ins_screening.hpp"

namespace kinfer::identify {
namespace {

constexpr std::array columns_of{&InsSensor::acceleration, &InsSensor::angular_velocity};
constexpr std::array instrument_of{"accelerometer", "gyroscope"};

void remove(TriadColumns& triad, const std::vector<bool>& rows) {
  for (auto& axis : triad.axis)
    for (std::size_t k = 0; k < axis.size(); ++k)
      if (rows[k]) axis[k] = std::numeric_limits<float>::quiet_NaN();
}

}  // namespace

void mend_rows(MendedLog& log, int threads) {
  const std::size_t sensors = log.log().sensors.size();
  std::vector<std::array<SampleOrigin, 2>> origins(sensors);
  parallel_for(sensors, threads, [&](std::size_t s) {
    for (std::size_t i = 0; i < 2; ++i)
      if (const TriadColumns& triad = log.log().sensors[s].*columns_of[i]; triad.present())
        origins[s][i] = sample_origin(triad);
  });
  for (std::size_t s = 0; s < sensors; ++s) {
    bool is_edited = false;
    for (std::size_t i = 0; i < 2; ++i) {
      const SampleOrigin& origin = origins[s][i];
      const bool repeats = origin.repeated_share > max_repeated_share;
      if (!repeats && !(origin.interpolated_share > max_repeated_share)) continue;
      InsSensor& sensor = log.edit().sensors[s];
      remove(sensor.*columns_of[i], repeats ? origin.repeated : origin.interpolated);
      is_edited = true;
      log.findings.push_back({.kind = repeats ? FindingKind::repeated_rows : FindingKind::interpolated_rows,
                              .severity = Severity::warning,
                              .values = {{"sensor", sensor.name},
                                         {"instrument", std::string(instrument_of[i])},
                                         {"share", repeats ? origin.repeated_share : origin.interpolated_share}},
                              .applied = true});
    }
    if (is_edited) flag_faults(log.edit().sensors[s]);
  }
}

}  // namespace kinfer::identify
