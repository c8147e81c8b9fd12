// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/diagnosis/neighbours.hpp"

#include <limits>

#include "kinfer/identify/diagnosis/thresholds.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"

namespace kinfer::identify {

double tree_length(const InsRecording& recording, int threads) {
  const auto ordered = order_segments(recording, {}, {}, threads);
  if (!ordered) return std::numeric_limits<double>::infinity();
  double length = 0.0;
  for (std::size_t s = 0; s < ordered->tree.parent.size(); ++s)
    if (ordered->tree.parent[s]) length += ordered->tree.pair(s, *ordered->tree.parent[s]).distance;
  return length;
}

void withdraw_contradicted_maps(MendedLog& log, const std::vector<MappedSensor>& mapped, int threads) {
  if (mapped.empty()) return;
  double length = tree_length(log.log(), threads);
  for (const MappedSensor& m : mapped) {
    InsRecording before = log.log();
    before.sensors[m.sensor] = m.before;
    const double without = tree_length(before, threads);
    if (!(length - without > min_sign_gain)) continue;
    length = without;
    log.edit().sensors[m.sensor] = m.before;
    std::erase_if(log.findings, [&](const Finding& f) {
      return (f.kind == FindingKind::rate_sign || f.kind == FindingKind::instrument_axes) &&
             f.values.text("sensor") == m.before.name;
    });
  }
}

}  // namespace kinfer::identify
