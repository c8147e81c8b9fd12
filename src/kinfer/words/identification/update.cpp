// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/identification/update.hpp"

#include <fmt/ranges.h>

#include <cmath>
#include <vector>

#include "kinfer/base/angle.hpp"
#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

/// The size of a change. Of a sensor at an end of the chain, the turn about its only axis is not seen.
std::string sizes_text(const ChainChange& change) {
  const char* least = change.alternative.empty() ? "" : "at least ";
  std::vector<std::string> sizes;
  if (change.angle)
    sizes.push_back(phrase("turned", "turned by {}{:.2f}° (sd {:.2f}°)", least, change.angle->value / degree,
                           change.angle->sd / degree));
  if (change.distance)
    sizes.push_back(phrase("moved", "moved by {}{:.1f} mm (sd {:.1f} mm)", least, 1e3 * change.distance->value,
                           1e3 * change.distance->sd));
  return sizes.empty() ? phrase("size_unknown", "by how much these logs do not tell")
                       : fmt::format("{}", fmt::join(sizes, ", "));
}

std::string certainty_text(double log_odds) {
  constexpr double beyond_doubt = 13.8;  // ln of a million
  return log_odds > beyond_doubt ? phrase("beyond_doubt", "beyond doubt")
                                 : phrase("odds", "odds {:.2g} to 1", std::exp(log_odds));
}

}  // namespace

std::string change_sentence(const ChainChange& change) {
  const std::string size = sizes_text(change), odds = certainty_text(change.log_odds);
  if (change.kind == ChainChangeKind::joint_moved)
    return phrase("joint_moved", "the joint {} is elsewhere on the segment of {}: {} ({})", change.name, change.segment,
                  size, odds);
  std::string text = phrase("sensor_moved", "{} sits otherwise on its segment: {} ({})", change.name, size, odds);
  if (change.alternative.empty()) return text;
  return text + phrase("moved_joint_instead", "; if it was not touched, the joint {} moved on this segment",
                       change.alternative);
}

std::string update_sentence(const ChainUpdate& update) {
  if (update.changes.empty())
    return phrase("nothing_changed",
                  "nothing changed since the last identification; the chain is that of both logs together");
  std::vector<std::string> sentences;
  for (const ChainChange& change : update.changes) sentences.push_back(change_sentence(change));
  return phrase("changed_since", "{} {} since the last identification: {}; all else is that of both logs together",
                sentences.size(), sentences.size() == 1 ? "change" : "changes", fmt::join(sentences, "; "));
}

}  // namespace kinfer::words
