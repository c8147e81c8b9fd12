// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/motion/path.hpp"

#include <algorithm>

#include "kinfer/words/language.hpp"

namespace kinfer::words {

namespace {

/// Of a joint that rotates, of one that slides, or of either.
std::string amount(double cut, const std::vector<bool>& rotational) {
  const auto rotating = std::ranges::count(rotational, true);
  if (rotating == std::ssize(rotational)) return fmt::format("{:.2f} deg", cut);
  return rotating == 0 ? fmt::format("{:.1f} mm", cut) : fmt::format("{:.2f} deg or mm", cut);
}

/// Without those that no posture reaches: the tool passes beside them.
std::string waypoints(const PathResult& result) {
  const std::size_t passed = result.path.passing_times.size();
  std::size_t met = passed;
  for (std::size_t k = 0; k < std::min(passed, result.targets.size()); ++k)
    if (result.targets[k].status != ReachStatus::reached) --met;
  const std::size_t all = result.targets.empty() ? passed : result.targets.size();
  return met == all ? fmt::format("{} waypoints", all) : fmt::format("{} of {} waypoints", met, all);
}

}  // namespace

std::string summary(const PathResult& result, const std::vector<bool>& rotational) {
  const TimedPath& path = result.path;
  const double cut = path.cuts.empty() ? 0.0 : *std::ranges::max_element(path.cuts);
  std::string text = fmt::format("{:.3f} s, {}", path.duration, waypoints(result));
  if (cut > 0.0) text += fmt::format(", corners are cut by up to {} of a joint", amount(cut, rotational));
  if (path.slowed_by > 1.0)
    text +=
        fmt::format(", {:.2f} times as long as the tool alone needs: the joints are at their limits", path.slowed_by);
  return phrase("path", "{}", text);
}

std::string sentence(const PathObstacle& obstacle, const std::vector<std::string>& joint_names) {
  const std::string where = fmt::format("line {}, {:.3f} s", obstacle.line + 1, obstacle.time);
  switch (obstacle.kind) {
    case PathObstacle::Kind::outside_limits:
      return phrase("outside_limits", "{}: {} leaves its limits", where,
                    joint_names[static_cast<std::size_t>(obstacle.joint)]);
    case PathObstacle::Kind::near_singular:
      return phrase("near_singular", "{}: the line passes a singular posture", where);
    case PathObstacle::Kind::not_reached:
      break;
  }
  return phrase("not_reached", "{}: the line leaves the postures that go on from its beginning", where);
}

}  // namespace kinfer::words
