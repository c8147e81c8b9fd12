// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/pairing/pair_rests.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>

#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

constexpr double usual_drift = 1e-4;  // [s/s] standard deviation between two clocks of computers and instruments
/// Two offsets explain the rests equally well unless the distances, or else the times, of one fit this much better. Set
/// on simulated programs of equal and of random dwell times.
constexpr double clearly_better = 3.0;
constexpr std::size_t least_pairs = 3;
constexpr double comparable_pairs = 0.7;  // of the most: with fewer an offset is no rival, however well they fit
/// [m] Distances of a nominal model are assumed to be at least so accurate: larger errors are of rows that do not
/// belong together.
constexpr double nominal_accuracy = 2e-3;
constexpr double parting_factor = 10.0;  // of the median distance error: there the rows no longer belong together

Vec3 measured_point(const RestLists& lists, int index) {
  return lists.measured[static_cast<std::size_t>(index)].mean.head<3>();
}

/// |measured − predicted| of each distance between successive pairs [m].
std::vector<double> distance_errors(const RestLists& lists, const std::vector<RestPair>& pairs) {
  std::vector<double> errors;
  if (lists.predicted.empty()) return errors;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const auto predicted = [&](std::size_t k) { return lists.predicted[static_cast<std::size_t>(pairs[k].joints)]; };
    const double measured =
        (measured_point(lists, pairs[i].measured) - measured_point(lists, pairs[i - 1].measured)).norm();
    errors.push_back(std::abs(measured - (predicted(i) - predicted(i - 1)).norm()));
  }
  return errors;
}

/// 0 where no distances are predicted.
double median_distance_error(const RestLists& lists, const std::vector<RestPair>& pairs) {
  const std::vector<double> errors = distance_errors(lists, pairs);
  return errors.empty() ? 0.0 : median(errors);
}

/// Fills what follows from the pairs.
RestPairing completed(RestPairing pairing, const RestLists& lists) {
  std::vector<bool> joints(lists.joints.size(), false), measured(lists.measured.size(), false);
  for (const RestPair& pair : pairing.pairs)
    joints[static_cast<std::size_t>(pair.joints)] = measured[static_cast<std::size_t>(pair.measured)] = true;
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (!joints[i]) pairing.joints_alone.push_back(static_cast<int>(i));
  for (std::size_t i = 0; i < measured.size(); ++i)
    if (!measured[i]) pairing.measured_alone.push_back(static_cast<int>(i));
  pairing.distance_error = median_distance_error(lists, pairing.pairs);
  return pairing;
}

// ---- time ----

/// time of the tracker = time of the robot + offset + drift · (time of the robot − origin)
struct ClockFit {
  double origin = 0.0, offset = 0.0, drift = 0.0;
  double at(double time) const { return time + offset + drift * (time - origin); }
};

/// Each rest of the robot with the rest of the tracker that it overlaps most, if that overlap is mutual and at least
/// half of the shorter one.
std::vector<RestPair> overlapping_pairs(const RestLists& lists, const ClockFit& clock) {
  const auto overlap = [&](const Rest& a, const Rest& b) {
    return std::min(clock.at(a.end), b.end) - std::max(clock.at(a.begin), b.begin);
  };
  std::vector<RestPair> pairs;
  std::size_t next = 0;
  for (std::size_t i = 0; i < lists.joints.size(); ++i) {
    const Rest& a = lists.joints[i];
    while (next < lists.measured.size() && lists.measured[next].end < clock.at(a.begin)) ++next;
    std::optional<std::size_t> best;
    for (std::size_t k = next; k < lists.measured.size() && lists.measured[k].begin < clock.at(a.end); ++k)
      if (!best || overlap(a, lists.measured[k]) > overlap(a, lists.measured[*best])) best = k;
    if (!best) continue;
    const Rest& b = lists.measured[*best];
    if (overlap(a, b) < 0.5 * std::min(a.end - a.begin, b.end - b.begin)) continue;
    if (!pairs.empty() && pairs.back().measured == static_cast<int>(*best)) {
      if (overlap(a, b) <= overlap(lists.joints[static_cast<std::size_t>(pairs.back().joints)], b)) continue;
      pairs.pop_back();
    }
    pairs.push_back({static_cast<int>(i), static_cast<int>(*best)});
  }
  return pairs;
}

/// Offset and drift by least squares of the begins and ends of the pairs; returns the rms that is left.
double refit_clock(const RestLists& lists, const std::vector<RestPair>& pairs, ClockFit& clock) {
  // Beside the offset of two clocks, 10⁹ s where one counts from 1970, the squares of what drifts would be lost.
  const double offset = lists.measured[static_cast<std::size_t>(pairs.front().measured)].begin -
                        lists.joints[static_cast<std::size_t>(pairs.front().joints)].begin;
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, syy = 0.0;
  for (const RestPair& pair : pairs) {
    const Rest &a = lists.joints[static_cast<std::size_t>(pair.joints)],
               &b = lists.measured[static_cast<std::size_t>(pair.measured)];
    for (const auto& [from, to] : {std::pair(a.begin, b.begin), std::pair(a.end, b.end)}) {
      const double x = from - clock.origin, y = (to - from) - offset;
      n += 1.0, sx += x, sy += y, sxx += x * x, sxy += x * y, syy += y * y;
    }
  }
  // Begins and ends of rests are told less exactly than clocks run: the drift has a prior.
  const double spread = sxx - sx * sx / n, variance = (syy - sy * sy / n) / n;
  clock.drift = spread > 0.0 ? (sxy - sx * sy / n) / (spread + variance / (usual_drift * usual_drift)) : 0.0;
  const double rest = (sy - clock.drift * sx) / n;
  clock.offset = offset + rest;
  const double squares = syy - 2.0 * rest * sy - 2.0 * clock.drift * sxy + n * rest * rest +
                         2.0 * rest * clock.drift * sx + clock.drift * clock.drift * sxx;
  return std::sqrt(std::max(0.0, squares) / n);
}

struct TimePairing {
  ClockFit clock;
  std::vector<RestPair> pairs{};
  double rms = 0.0;
  double distance = 0.0;
};

TimePairing pair_from(const RestLists& lists, double offset) {
  TimePairing found;
  found.clock = {.origin = lists.joints.front().begin, .offset = offset};
  constexpr int rounds = 4;
  for (int round = 0; round < rounds; ++round) {
    found.pairs = overlapping_pairs(lists, found.clock);
    if (found.pairs.size() < 2) break;
    found.rms = refit_clock(lists, found.pairs, found.clock);
  }
  found.distance = median_distance_error(lists, found.pairs);
  return found;
}

/// Every way in which an offset pairs the rests, those with much fewer pairs than another left out.
std::vector<TimePairing> time_pairings(const RestLists& lists, std::optional<double> offset) {
  std::vector<TimePairing> candidates;
  std::set<std::vector<RestPair>> known;
  const auto add = [&](double tried) {
    TimePairing found = pair_from(lists, tried);
    if (found.pairs.size() >= least_pairs && known.insert(found.pairs).second) candidates.push_back(std::move(found));
  };
  if (offset) {
    add(*offset);
    return candidates;
  }
  std::set<std::int64_t> tried;
  for (const Rest& a : lists.joints)
    for (const Rest& b : lists.measured) {
      constexpr double step = 0.1;  // [s] overlaps of rests, half a second long and more, hardly change within it
      if (const double at = b.begin - a.begin; tried.insert(std::llround(at / step)).second) add(at);
    }
  std::size_t most = 0;
  for (const TimePairing& candidate : candidates) most = std::max(most, candidate.pairs.size());
  std::erase_if(candidates, [&](const TimePairing& candidate) {
    return static_cast<double>(candidate.pairs.size()) < comparable_pairs * static_cast<double>(most);
  });
  return candidates;
}

/// Distances decide where they are known and differ clearly, else the number of pairs, else the times.
enum class Preference { first, second, none };
Preference preference(const TimePairing& a, const TimePairing& b, bool has_distances) {
  constexpr double shortest = 1e-6;  // [m] and [s]: rounding
  const auto compare = [](double x, double y) {
    if (clearly_better * (x + shortest) < y + shortest) return Preference::first;
    return clearly_better * (y + shortest) < x + shortest ? Preference::second : Preference::none;
  };
  if (has_distances)
    if (const Preference by = compare(a.distance, b.distance); by != Preference::none) return by;
  if (a.pairs.size() != b.pairs.size()) return a.pairs.size() > b.pairs.size() ? Preference::first : Preference::second;
  return compare(a.rms, b.rms);
}

}  // namespace

std::string_view name(PairingMethod method) {
  static constexpr std::array<std::string_view, 3> names{"name", "time", "order"};
  return names[static_cast<std::size_t>(method)];
}

Result<RestPairing> pair_by_name(const RestLists& lists) {
  std::map<std::string, int> measured;
  for (std::size_t k = 0; k < lists.measured.size(); ++k)
    if (!measured.emplace(lists.measured[k].name, static_cast<int>(k)).second)
      return error("the name \"{}\" stands in several places of the measured list", lists.measured[k].name);
  RestPairing pairing{.method = PairingMethod::name};
  std::map<std::string, int> joints;
  for (std::size_t i = 0; i < lists.joints.size(); ++i) {
    const std::string& name = lists.joints[i].name;
    if (!joints.emplace(name, static_cast<int>(i)).second)
      return error("the name \"{}\" stands in several places of the joint list", name);
    if (const auto found = measured.find(name); found != measured.end() && !name.empty())
      pairing.pairs.push_back({static_cast<int>(i), found->second});
  }
  if (pairing.pairs.empty()) return error("no name of the joint list stands in the measured list");
  return completed(std::move(pairing), lists);
}

Result<RestPairing> pair_by_time(const RestLists& lists, std::optional<double> offset) {
  if (std::min(lists.joints.size(), lists.measured.size()) < least_pairs)
    return error("{} rests of the robot and {} of the tracker were found; pairing by time needs three of each",
                 lists.joints.size(), lists.measured.size());
  const bool has_distances = !lists.predicted.empty();
  const std::vector<TimePairing> candidates = time_pairings(lists, offset);
  if (candidates.empty()) return error("no offset of the clocks brings three rests of robot and tracker together");
  std::size_t best = 0;
  for (std::size_t k = 1; k < candidates.size(); ++k)
    if (preference(candidates[k], candidates[best], has_distances) == Preference::first) best = k;
  for (std::size_t k = 0; k < candidates.size(); ++k)
    if (k != best && preference(candidates[best], candidates[k], has_distances) != Preference::first)
      return error(
          "offsets of {:.2f} s ({} pairs) and {:.2f} s ({} pairs) explain the rests equally well; give "
          "--offset, or names",
          candidates[best].clock.offset, candidates[best].pairs.size(), candidates[k].clock.offset,
          candidates[k].pairs.size());
  RestPairing pairing{.method = PairingMethod::time, .pairs = candidates[best].pairs};
  pairing.offset = candidates[best].clock.offset;
  pairing.drift = candidates[best].clock.drift;
  pairing.timing_error = candidates[best].rms;
  return completed(std::move(pairing), lists);
}

Result<RestPairing> pair_by_order(const RestLists& lists) {
  RestPairing pairing{.method = PairingMethod::order};
  const std::size_t common = std::min(lists.joints.size(), lists.measured.size());
  for (std::size_t i = 0; i < common; ++i) pairing.pairs.push_back({static_cast<int>(i), static_cast<int>(i)});
  if (lists.joints.size() == lists.measured.size()) return completed(std::move(pairing), lists);
  const std::vector<double> errors = distance_errors(lists, pairing.pairs);
  // Rows before the place belong together; a quarter of the errors are surely of such rows if the place is not early.
  std::vector<double> sorted = errors;
  std::ranges::sort(sorted);
  const double usual = sorted.empty() ? 0.0 : std::min(sorted[sorted.size() / 4], nominal_accuracy);
  const auto part = std::ranges::find_if(errors, [&](double e) { return e > parting_factor * usual + 1e-3; });
  if (errors.empty() || part == errors.end())
    return error("the joint list has {} rests and the measured list {}", lists.joints.size(), lists.measured.size());
  const auto place = static_cast<std::size_t>(part - errors.begin()) + 1;
  return error(
      "the joint list has {} rests and the measured list {}; they part at rest {}, where the point is {:.1f} mm "
      "nearer to or farther from the one before it than the model says",
      lists.joints.size(), lists.measured.size(), place + 1, 1e3 * *part);
}

}  // namespace kinfer
