// How long-running functions tell what they do: a callback handed in by the caller, who may print or ignore it.
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
  std::string_view detail;  ///< free words: a segment's name, a fold
};

enum class Wish { go_on, stop };

using Observer = std::function<Wish(const Progress&)>;

/// Tells the observer, if there is one; returns its wish.
inline Wish tell(const Observer& observer, const Progress& progress) {
  return observer ? observer(progress) : Wish::go_on;
}

}  // namespace kinfer
