#include "kinfer/identify/remount.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kinfer/base/parallel.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr std::size_t remount_rows = 900, splits = 24, finer = 9;
constexpr double telling_rate = 0.05;    // [rad/s] rate of a row that tells something
constexpr std::size_t least_rows = 100;  // on either side
constexpr double gravity = 9.81;         // [m/s²] as the motion's accelerations are freed of

/// The two relations by one form: |v_a| = |v_b|, v = constant + effect · p with p of the sensor.
struct Relation {
  double scale = 0.0;  // of a residual beyond which it counts less and less
  double least = 0.0;  // rms that even a perfect joint leaves
  bool unit = false;   // p is a direction
  double far = 0.0;    // a change of p worth the name
  double near = 0.0;   // rows' worth of wish that p stays near 0: directions that nothing tells
};
constexpr Relation of_rates{.scale = 0.02, .least = 0.0005, .unit = true, .far = 0.03, .near = 0.0};   // [rad/s], [rad]
constexpr Relation of_forces{.scale = 0.2, .least = 0.015, .unit = false, .far = 0.03, .near = 0.05};  // [m/s²], [m]
constexpr double broken = 3.0;   // times what joints leave: a relation that does not hold
constexpr double holding = 3.0;  // times: one that does

struct Row {
  Vec3 constant = Vec3::Zero();
  Mat3 effect = Mat3::Zero();
};
using Rows = std::vector<Row>;

/// One sensor's part of a relation at the judged rows.
Rows rows_of(const SegmentMotion& m, const std::vector<std::size_t>& at, const Relation& relation) {
  Rows rows;
  for (const std::size_t i : at) {
    const Mat3 to_sensor = m.rotation[i].transpose();
    const Vec3 rate = to_sensor * m.rate[i];
    if (relation.unit) {
      rows.push_back({Vec3::Zero(), skew(rate)});
      continue;
    }
    const Mat3 turn = skew(rate);
    rows.push_back(
        {to_sensor * (m.acceleration[i] + Vec3(0.0, 0.0, gravity)), skew(to_sensor * m.rate_change[i]) + turn * turn});
  }
  return rows;
}

/// Parameters of the two sensors, before and after the split; equal where they are held together.
using Parts = std::array<std::array<Vec3, 2>, 2>;  // [sensor][part]

struct Separate {
  bool first = false, second = false;
};

struct Fit {
  Parts p;
  double rms = 0.0;  // [rad/s] or [m/s²], a residual counting at most five scales
};

class PairRelation {
 public:
  PairRelation(const Rows& a, const Rows& b, const Relation& relation) : sides_{&a, &b}, relation_(relation) {}

  Fit fit(std::size_t split, Separate separate) const {
    Fit best{.p = {}, .rms = std::numeric_limits<double>::infinity()};
    for (const Vec3& first : starts())
      for (const Vec3& second : starts()) {
        const Fit found = descended({{{first, first}, {second, second}}}, split, separate);
        if (found.rms < best.rms) best = found;
      }
    return best;
  }

 private:
  std::vector<Vec3> starts() const {
    if (!relation_.unit) return {Vec3::Zero()};
    return {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  }

  double residual(const Parts& p, std::size_t row, std::size_t part) const {
    std::array<double, 2> norm{};
    for (std::size_t s = 0; s < 2; ++s) {
      const Row& r = (*sides_[s])[row];
      norm[s] = (r.constant + r.effect * p[s][part]).norm();
    }
    return norm[0] - norm[1];
  }

  /// The smoothing mixes before and after.
  static bool is_smeared(std::size_t row, std::size_t split) { return row + 2 >= split && row < split + 2; }

  double rms(const Parts& p, std::size_t split) const {
    double sum = 0.0;
    for (std::size_t row = 0; row < sides_[0]->size(); ++row)
      if (!is_smeared(row, split))
        sum += std::pow(std::min(std::abs(residual(p, row, row >= split)), 5.0 * relation_.scale), 2);
    return std::sqrt(sum / static_cast<double>(sides_[0]->size()));
  }

  /// Levenberg-Marquardt with Huber's weights.
  Fit descended(Parts p, std::size_t split, Separate separate) const {
    constexpr int iterations = 12;
    Fit best{p, rms(p, split)};
    double damping = 1e-3;
    for (int i = 0; i < iterations; ++i) {
      MatrixXd matrix = MatrixXd::Zero(12, 12);
      VectorXd right = VectorXd::Zero(12);
      gather(best.p, split, separate, matrix, right);
      matrix.diagonal() *= 1.0 + damping;
      matrix.diagonal().array() += 1e-6;
      const auto step = solve_positive(matrix, right);
      if (!step) break;
      const Parts trial = moved(best.p, *step, separate);
      const double error = rms(trial, split);
      const bool better = error < best.rms;
      const bool done = better && best.rms - error < 1e-4 * best.rms;
      if (better) best = {trial, error};
      damping = better ? 0.1 * damping : 10.0 * damping;
      if (done || damping > 1e6) break;
    }
    return best;
  }

  static Index column(std::size_t sensor, std::size_t part, Separate separate) {
    const bool own = sensor == 0 ? separate.first : separate.second;
    return static_cast<Index>(6 * sensor + (own ? 3 * part : 0));
  }

  void gather(const Parts& p, std::size_t split, Separate separate, MatrixXd& matrix, VectorXd& right) const {
    for (std::size_t row = 0; row < sides_[0]->size(); ++row) {
      if (is_smeared(row, split)) continue;
      const std::size_t part = row >= split;
      std::array<Vec3, 2> slope;
      std::array<double, 2> norm{};
      for (std::size_t s = 0; s < 2; ++s) {
        const Row& r = (*sides_[s])[row];
        const Vec3 v = r.constant + r.effect * p[s][part];
        norm[s] = v.norm();
        slope[s] = (s == 0 ? 1.0 : -1.0) / std::max(norm[s], 1e-9) * (r.effect.transpose() * v);
      }
      const double e = norm[0] - norm[1], weight = std::min(1.0, relation_.scale / std::max(std::abs(e), 1e-12));
      const std::array<Index, 2> at{column(0, part, separate), column(1, part, separate)};
      for (std::size_t s = 0; s < 2; ++s) {
        right.segment<3>(at[s]) -= weight * e * slope[s];
        for (std::size_t k = 0; k < 2; ++k)
          matrix.block<3, 3>(at[s], at[k]) += weight * slope[s] * slope[k].transpose();
      }
    }
    for (std::size_t s = 0; s < 2; ++s)
      for (std::size_t part = 0; part < 2; ++part) {
        const Index at = column(s, part, separate);
        matrix.diagonal().segment<3>(at).array() += relation_.near;
        right.segment<3>(at) -= relation_.near * p[s][part];
      }
    for (std::size_t s = 0; s < 2 && relation_.unit; ++s)  // directions keep their length
      for (std::size_t part = 0; part < 2; ++part) {
        const Index at = column(s, part, separate);
        matrix.block<3, 3>(at, at) += static_cast<double>(sides_[0]->size()) * p[s][part] * p[s][part].transpose();
      }
  }

  Parts moved(Parts p, const VectorXd& step, Separate separate) const {
    for (std::size_t s = 0; s < 2; ++s)
      for (std::size_t part = 0; part < 2; ++part) {
        p[s][part] += step.segment<3>(column(s, part, separate));
        if (relation_.unit) p[s][part].normalize();
      }
    return p;
  }

  std::array<const Rows*, 2> sides_;
  Relation relation_;
};

/// Whether a pair says that the first of its sensors changed at a split: the rms that is left then.
struct Evidence {
  std::size_t split = 0;
  bool changed = false;
  double rms = 0.0;
  double change = 0.0;  // of the sensor's direction [rad] or point [m]
};

Evidence evidence_of(const PairRelation& pair, const Relation& relation, double together, double usual,
                     std::size_t split) {
  const Fit own = pair.fit(split, {.first = true});
  const Vec3 &before = own.p[0][0], &after = own.p[0][1];
  const double change = relation.unit ? std::asin(std::min(1.0, before.cross(after).norm())) : (before - after).norm();
  const bool changed = own.rms < holding * usual && together > broken * own.rms && change > relation.far;
  return {split, changed, own.rms, change};
}

/// The judged rows: usable, something moves, evenly spread.
std::vector<std::size_t> telling_rows(const RecordedMotion& motion) {
  std::vector<std::size_t> rows, chosen;
  for (std::size_t i = motion.first_motion; i < motion.rows(); ++i)
    if (motion.usable[i] &&
        std::ranges::any_of(motion.segments, [&](const SegmentMotion& m) { return m.rate[i].norm() > telling_rate; }))
      rows.push_back(i);
  const std::size_t stride = std::max<std::size_t>(1, rows.size() / remount_rows);
  for (std::size_t i = 0; i < rows.size(); i += stride) chosen.push_back(rows[i]);
  return chosen;
}

class Search {
 public:
  Search(const RecordedMotion& motion, int threads) : motion_(motion), at_(telling_rows(motion)), threads_(threads) {
    for (const SegmentMotion& segment : motion.segments)
      rows_.push_back({rows_of(segment, at_, of_rates), rows_of(segment, at_, of_forces)});
  }

  std::optional<Remount> run() const {
    if (at_.size() < 2 * least_rows) return std::nullopt;
    std::optional<Candidate> best;
    for (const Suspect& suspect : suspects())
      if (const auto found = changed_between(suspect); found && (!best || found->clarity > best->clarity)) best = found;
    if (!best) return std::nullopt;
    return told(*best);
  }

 private:
  /// A relation of a sensor that holds with none of its neighbours over the whole recording.
  struct Suspect {
    std::size_t sensor = 0, neighbour = 0, relation = 0;
    double together = 0.0, usual = 0.0;  // rms of this pair; of joints
  };
  struct Candidate {
    Suspect suspect;
    std::size_t first = 0, best = 0, last = 0;  // splits between which, and at which best, the change explains all
    double clarity = 0.0;                       // how many times less is left then
    double change = 0.0;
  };

  static const Relation& relation(std::size_t k) { return k == 0 ? of_rates : of_forces; }

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
      pairs[i].together = pair(pairs[i].sensor, pairs[i].neighbour, pairs[i].relation).fit(at_.size(), {}).rms;
    });
    std::vector<Suspect> all;
    for (std::size_t k = 0; k < 2; ++k) {
      const std::vector<double> best = best_of_sensors(pairs, k);
      const double usual = usual_of(best, relation(k).least);
      for (const Suspect& p : pairs)
        for (const auto& [sensor, neighbour] : {std::pair{p.sensor, p.neighbour}, {p.neighbour, p.sensor}})
          if (p.relation == k && best[sensor] > broken * usual)
            all.push_back({sensor, neighbour, k, p.together, usual});
    }
    return all;
  }

  /// What is left of a sensor's best relation; infinite for one that stands still.
  std::vector<double> best_of_sensors(const std::vector<Suspect>& pairs, std::size_t k) const {
    std::vector<double> best(rows_.size(), std::numeric_limits<double>::infinity());
    for (const Suspect& p : pairs)
      if (p.relation == k)
        for (const std::size_t s : {p.sensor, p.neighbour}) best[s] = std::min(best[s], p.together);
    return best;
  }

  static double usual_of(std::vector<double> best, double least) {
    std::erase_if(best, [](double b) { return !std::isfinite(b); });
    if (best.empty()) return least;
    std::ranges::sort(best);
    return std::max(least, best[(best.size() - 1) / 2]);
  }

  /// Evenly spread splits from one to another, tried.
  std::vector<Evidence> tried(const Suspect& suspect, std::size_t from, std::size_t to, std::size_t count) const {
    const PairRelation p = pair(suspect.sensor, suspect.neighbour, suspect.relation);
    std::vector<Evidence> found(count);
    parallel_for(count, threads_, [&](std::size_t k) {
      found[k] = evidence_of(p, relation(suspect.relation), suspect.together, suspect.usual,
                             from + (to - from) * k / (count - 1));
    });
    return found;
  }

  /// Coarsely all over the recording, then ever finer about the best.
  std::vector<Evidence> scanned(const Suspect& suspect) const {
    const std::size_t least = least_rows, most = at_.size() - least_rows;
    std::vector<Evidence> all = tried(suspect, least, most, splits);
    for (std::size_t step = (most - least) / (splits - 1); step > 1; step = 2 * step / (finer - 1)) {
      const std::size_t best = std::ranges::min_element(all, {}, &Evidence::rms)->split;
      const auto more =
          tried(suspect, std::max(least, best - std::min(step, best)), std::min(most, best + step), finer);
      all.insert(all.end(), more.begin(), more.end());
    }
    std::ranges::stable_sort(all, {}, &Evidence::split);
    return all;
  }

  std::optional<Candidate> changed_between(const Suspect& suspect) const {
    const std::vector<Evidence> found = scanned(suspect);
    const auto best = static_cast<std::size_t>(std::ranges::min_element(found, {}, &Evidence::rms) - found.begin());
    if (!found[best].changed) return std::nullopt;
    constexpr double as_good = 1.5;
    std::size_t first = best, last = best;
    while (first > 0 && found[first].rms <= as_good * found[best].rms) --first;
    while (last + 1 < found.size() && found[last].rms <= as_good * found[best].rms) ++last;
    return Candidate{suspect,
                     found[first].split,
                     found[best].split,
                     found[last].split,
                     suspect.together / std::max(found[best].rms, relation(suspect.relation).least),
                     found[best].change};
  }

  Remount told(const Candidate& found) const {
    const auto time = [&](std::size_t split) { return motion_.time[at_[std::min(split, at_.size() - 1)]]; };
    Remount remount{.segment = found.suspect.sensor, .begin = time(found.first), .end = time(found.last)};
    for (std::size_t k = 0; k < 2; ++k) {
      const Fit fit = pair(found.suspect.sensor, found.suspect.neighbour, k).fit(found.best, {.first = true});
      const Vec3 &before = fit.p[0][0], &after = fit.p[0][1];
      if (k == 0) remount.turn = std::asin(std::min(1.0, before.cross(after).norm()));
      if (k == 1) remount.shift = (before - after).norm();
    }
    return remount;
  }

  const RecordedMotion& motion_;
  std::vector<std::size_t> at_;
  int threads_;
  std::vector<std::array<Rows, 2>> rows_;  // of each segment, each relation
};

/// How much all joints of the tree move from one time to another, the laziest counting most [log].
double excitation(const OrderedMotion& ordered, double begin, double end) {
  constexpr double next_to_nothing = 0.02;  // [rad²/s]
  const RecordedMotion& motion = ordered.motion;
  double sum = 0.0;
  for (std::size_t child = 0; child < motion.segments.size(); ++child) {
    if (!ordered.tree.parent[child]) continue;
    const SegmentMotion &a = motion.segments[*ordered.tree.parent[child]], &b = motion.segments[child];
    double turning = next_to_nothing;
    for (std::size_t i = 0; i < motion.rows(); ++i)
      if (motion.time[i] > begin && motion.time[i] < end)
        turning += motion.period * std::pow(b.gyro[i].norm() - a.gyro[i].norm(), 2);
    sum += std::log(turning);
  }
  return sum;
}

}  // namespace

std::optional<Remount> find_remount(const OrderedMotion& ordered, int threads) {
  auto found = Search(ordered.motion, threads).run();
  if (found)
    found->before_tells_more = excitation(ordered, ordered.motion.time.front(), found->begin) >
                               excitation(ordered, found->end, ordered.motion.time.back());
  return found;
}

Finding finding_about(const Remount& remount, const RecordedMotion& motion) {
  constexpr double degrees = 57.29577951308232;
  return {
      .kind = "remounted",
      .severity = Severity::warning,
      .sentence = fmt::format("the mounting of {} changed between {:.1f} and {:.1f} s: a joint's axis turned by "
                              "{:.1f} deg in it and the joint's point moved by about {:.0f} mm; only what was "
                              "recorded {} is used",
                              motion.segments[remount.segment].name, remount.begin, remount.end, degrees * remount.turn,
                              1e3 * remount.shift, remount.before_tells_more ? "before" : "after"),
      .suggestion = "fix the sensor and record again, or give each part a log of its own",
      .applied = true};
}

}  // namespace kinfer
