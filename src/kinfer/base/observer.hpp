// SPDX-License-Identifier: Apache-2.0
// Progress reports of long-running functions: a callback passed in by the caller, who may print or ignore them.
#pragma once

#include <functional>
#include <string_view>

namespace kinfer {

struct Progress {
  std::string_view stage;  ///< what is being done: "fit", "cross-validation"
  double fraction = 0.0;   ///< of the stage, 0 .. 1
  double best = 0.0;       ///< best cost so far, in the stage's own unit
  double median = 0.0;     ///< of the population, where there is one
  int iteration = 0;
  std::string_view detail;  ///< free text: a segment's name, a fold
};

/// `stop` ends the current search and keeps its best result. To end the whole computation an observer may throw: its
/// exception reaches whoever called the long-running function.
enum class ObserverDecision { proceed, stop };

using Observer = std::function<ObserverDecision(const Progress&)>;

/// Notifies the observer, if there is one; returns whether it wants to continue.
inline ObserverDecision notify(const Observer& observer, const Progress& progress) {
  return observer ? observer(progress) : ObserverDecision::proceed;
}

}  // namespace kinfer
