// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/remount.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/parallel.hpp"
#include "kinfer/identify/screening/pair_relation.hpp"
#include "kinfer/identify/screening/thresholds.hpp"

namespace kinfer::identify {
namespace {

constexpr std::size_t remount_rows = 900, coarse_splits = 24, fine_splits = 9;

/// Evidence of a pair that its first sensor was remounted at a split, with the residual rms.
struct SplitEvidence {
  std::size_t split = 0;
  bool changed = false;
  double rms = 0.0;
  double change = 0.0;  // of the sensor's direction [rad] or point [m]
};

/// Whether both parts determine the neighbour's axis. Where it is at rest in one of them, its axis may have changed,
/// too: a joint that rotates about two axes one after the other.
bool neighbour_is_constant(const PairRelation& pair, const SplitFit& own, std::size_t split) {
  const auto determines = [&](std::size_t part) {
    return pair.rms_across(own, split, part) > broken_relation_factor * own.rms;
  };
  return determines(0) && determines(1);
}

SplitEvidence split_evidence(const PairRelation& pair, const MountRelation& relation, double constant_rms,
                             double usual_rms, std::size_t split) {
  const SplitFit own = pair.fit(split, {.first = true});
  const Vec3 &before = own.p[0][0], &after = own.p[0][1];
  const double change =
      relation.is_direction ? std::asin(std::min(1.0, before.cross(after).norm())) : (before - after).norm();
  const bool changed = own.rms < holding_relation_factor * usual_rms &&
                       constant_rms > broken_relation_factor * own.rms && change > relation.min_change &&
                       (!relation.is_direction || neighbour_is_constant(pair, own, split));
  return {split, changed, own.rms, change};
}

/// The evaluated rows: usable, at least one segment rotates, evenly spaced.
std::vector<std::size_t> telling_rows(const RecordedMotion& motion) {
  std::vector<std::size_t> rows, chosen;
  for (std::size_t i = motion.first_motion_row; i < motion.rows(); ++i)
    if (motion.usable[i] && std::ranges::any_of(motion.segments, [&](const SegmentMotion& m) {
          return m.angular_velocity[i].norm() > informative_rate;
        }))
      rows.push_back(i);
  const std::size_t stride = std::max<std::size_t>(1, rows.size() / remount_rows);
  for (std::size_t i = 0; i < rows.size(); i += stride) chosen.push_back(rows[i]);
  return chosen;
}

class RemountSearch {
 public:
  RemountSearch(const RecordedMotion& motion, int threads)
      : motion_(motion), at_(telling_rows(motion)), threads_(threads) {
    for (const SegmentMotion& segment : motion.segments)
      rows_.push_back({relation_rows(segment, at_, gyro_relation, motion.gravity),
                       relation_rows(segment, at_, force_relation, motion.gravity)});
  }

  std::optional<Remount> run() const {
    if (at_.size() < 2 * min_rows_beside_split) return std::nullopt;
    std::optional<Candidate> best;
    for (const Suspect& suspect : suspects())
      if (const auto found = find_change(suspect); found && (!best || found->residual_ratio > best->residual_ratio))
        best = found;
    if (!best) return std::nullopt;
    return remount_of(*best);
  }

 private:
  /// A relation that a sensor fulfils with no other sensor over the whole recording.
  struct Suspect {
    std::size_t sensor = 0, neighbour = 0, relation = 0;
    double constant_rms = 0.0, usual_rms = 0.0;  // residual rms of this pair; of the usual joint
  };
  struct Candidate {
    Suspect suspect;
    std::size_t first = 0, best = 0, last = 0;  // range of splits that explain the change, and the best one
    double residual_ratio = 0.0;                // ratio of the residual without the change to that with it
    double change = 0.0;
  };

  static const MountRelation& relation(std::size_t k) { return k == 0 ? gyro_relation : force_relation; }

  PairRelation pair(std::size_t sensor, std::size_t neighbour, std::size_t k) const {
    return {rows_[sensor][k], rows_[neighbour][k], relation(k)};
  }

  std::vector<Suspect> suspects() const {
    const std::size_t n = rows_.size();
    std::vector<Suspect> pairs;
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = a + 1; b < n; ++b)
        for (std::size_t k = 0; k < 2; ++k)
          if (!motion_.segments[a].still && !motion_.segments[b].still) pairs.push_back({a, b, k});
    parallel_for(pairs.size(), threads_, [&](std::size_t i) {
      pairs[i].constant_rms = pair(pairs[i].sensor, pairs[i].neighbour, pairs[i].relation).fit(at_.size(), {}).rms;
    });
    std::vector<Suspect> all;
    for (std::size_t k = 0; k < 2; ++k) {
      const std::vector<double> best = least_residuals(pairs, k);
      const double usual_rms = usual_residual(best, relation(k).minimum);
      for (const Suspect& p : pairs)
        for (const auto& [sensor, neighbour] : {std::pair{p.sensor, p.neighbour}, {p.neighbour, p.sensor}})
          if (p.relation == k && best[sensor] > broken_relation_factor * usual_rms)
            all.push_back({sensor, neighbour, k, p.constant_rms, usual_rms});
    }
    return all;
  }

  /// Smallest residual over a sensor's pairs; infinite for a stationary sensor.
  std::vector<double> least_residuals(const std::vector<Suspect>& pairs, std::size_t k) const {
    std::vector<double> best(rows_.size(), std::numeric_limits<double>::infinity());
    for (const Suspect& p : pairs)
      if (p.relation == k)
        for (const std::size_t s : {p.sensor, p.neighbour}) best[s] = std::min(best[s], p.constant_rms);
    return best;
  }

  static double usual_residual(std::vector<double> best, double minimum) {
    std::erase_if(best, [](double b) { return !std::isfinite(b); });
    if (best.empty()) return minimum;
    std::ranges::sort(best);
    return std::max(minimum, best[(best.size() - 1) / 2]);
  }

  /// Evidence at evenly spaced splits.
  std::vector<SplitEvidence> evaluate_splits(const Suspect& suspect, std::size_t from, std::size_t to,
                                             std::size_t count) const {
    const PairRelation p = pair(suspect.sensor, suspect.neighbour, suspect.relation);
    std::vector<SplitEvidence> found(count);
    parallel_for(count, threads_, [&](std::size_t k) {
      found[k] = split_evidence(p, relation(suspect.relation), suspect.constant_rms, suspect.usual_rms,
                                from + (to - from) * k / (count - 1));
    });
    return found;
  }

  /// Coarse scan of the whole recording, then successively finer around the best split.
  std::vector<SplitEvidence> scan_splits(const Suspect& suspect) const {
    const std::size_t minimum = min_rows_beside_split, most = at_.size() - min_rows_beside_split;
    std::vector<SplitEvidence> all = evaluate_splits(suspect, minimum, most, coarse_splits);
    for (std::size_t step = (most - minimum) / (coarse_splits - 1); step > 1; step = 2 * step / (fine_splits - 1)) {
      const std::size_t best = std::ranges::min_element(all, {}, &SplitEvidence::rms)->split;
      const auto more = evaluate_splits(suspect, std::max(minimum, best - std::min(step, best)),
                                        std::min(most, best + step), fine_splits);
      all.insert(all.end(), more.begin(), more.end());
    }
    std::ranges::stable_sort(all, {}, &SplitEvidence::split);
    return all;
  }

  std::optional<Candidate> find_change(const Suspect& suspect) const {
    const std::vector<SplitEvidence> found = scan_splits(suspect);
    const auto best =
        static_cast<std::size_t>(std::ranges::min_element(found, {}, &SplitEvidence::rms) - found.begin());
    if (!found[best].changed) return std::nullopt;
    std::size_t first = best, last = best;
    while (first > 0 && found[first].rms <= max_split_ratio_to_best * found[best].rms) --first;
    while (last + 1 < found.size() && found[last].rms <= max_split_ratio_to_best * found[best].rms) ++last;
    return Candidate{suspect,
                     found[first].split,
                     found[best].split,
                     found[last].split,
                     suspect.constant_rms / std::max(found[best].rms, relation(suspect.relation).minimum),
                     found[best].change};
  }

  Remount remount_of(const Candidate& found) const {
    const auto time = [&](std::size_t split) { return motion_.time[at_[std::min(split, at_.size() - 1)]]; };
    Remount remount{.segment = found.suspect.sensor, .begin = time(found.first), .end = time(found.last)};
    for (std::size_t k = 0; k < 2; ++k) {
      const SplitFit fit = pair(found.suspect.sensor, found.suspect.neighbour, k).fit(found.best, {.first = true});
      const Vec3 &before = fit.p[0][0], &after = fit.p[0][1];
      if (k == 0) remount.axis_rotation = std::asin(std::min(1.0, before.cross(after).norm()));
      if (k == 1) remount.point_shift = (before - after).norm();
    }
    return remount;
  }

  const RecordedMotion& motion_;
  std::vector<std::size_t> at_;
  int threads_;
  std::vector<std::array<RelationRows, 2>> rows_;  // of each segment, each relation
};

/// Excitation of all joints of the tree between two times: sum of logarithms, so that the least moved counts most.
double excitation(const OrderedMotion& ordered, double begin, double end) {
  constexpr double excitation_floor = 0.02;  // [rad²/s]
  const RecordedMotion& motion = ordered.motion;
  double sum = 0.0;
  for (std::size_t child = 0; child < motion.segments.size(); ++child) {
    if (!ordered.tree.parent[child]) continue;
    const SegmentMotion &a = motion.segments[*ordered.tree.parent[child]], &b = motion.segments[child];
    double squared_rate_difference = excitation_floor;
    for (std::size_t i = 0; i < motion.rows(); ++i)
      if (motion.time[i] > begin && motion.time[i] < end)
        squared_rate_difference += motion.period * std::pow(b.gyro[i].norm() - a.gyro[i].norm(), 2);
    sum += std::log(squared_rate_difference);
  }
  return sum;
}

}  // namespace

std::optional<Remount> find_remount(const OrderedMotion& ordered, int threads) {
  auto found = RemountSearch(ordered.motion, threads).run();
  if (found)
    found->before_is_more_informative = excitation(ordered, ordered.motion.time.front(), found->begin) >
                                        excitation(ordered, found->end, ordered.motion.time.back());
  return found;
}

Finding finding_about(const Remount& remount, const RecordedMotion& motion) {
  return {.kind = FindingKind::remounted,
          .severity = Severity::warning,
          .values = {{"sensor", motion.segments[remount.segment].name},
                     {"begin", remount.begin},
                     {"end", remount.end},
                     {"axis_rotation", remount.axis_rotation},
                     {"point_shift", remount.point_shift},
                     {"used_part", std::string(remount.before_is_more_informative ? "before" : "after")}},
          .applied = true};
}

}  // namespace kinfer::identify
