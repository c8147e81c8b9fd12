// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/remount.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kinfer/base/parallel.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

constexpr std::size_t remount_rows = 900, coarse_splits = 24, fine_splits = 9;
constexpr double informative_rate = 0.05;  // [rad/s] angular velocity of an informative row
constexpr std::size_t min_rows = 100;      // on either side of a split

/// Common form of the two relations: |v_a| = |v_b|, v = constant + effect · p, p a parameter of the sensor (j or r).
struct Relation {
  double huber_threshold = 0.0;  // Huber threshold of a residual
  double minimum = 0.0;          // residual rms of an ideal joint
  bool is_direction = false;     // p is a direction
  double min_change = 0.0;       // smallest significant change of p
  double prior_weight = 0.0;     // prior weight (in rows) of p = 0, for unobservable directions
};
constexpr Relation gyro_relation{.huber_threshold = 0.02,
                                 .minimum = 0.0005,
                                 .is_direction = true,
                                 .min_change = 0.03,
                                 .prior_weight = 0.0};  // [rad/s], [rad]
constexpr Relation force_relation{.huber_threshold = 0.2,
                                  .minimum = 0.015,
                                  .is_direction = false,
                                  .min_change = 0.03,
                                  .prior_weight = 0.05};  // [m/s²], [m]
constexpr double broken_factor = 3.0;   // factor on the usual residual beyond which a relation does not hold
constexpr double holding_factor = 3.0;  // factor below which it holds

struct Row {
  Vec3 constant = Vec3::Zero();
  Mat3 jacobian = Mat3::Zero();
};
using Rows = std::vector<Row>;

/// One sensor's part of a relation at the evaluated rows.
Rows rows_of(const SegmentMotion& m, const std::vector<std::size_t>& at, const Relation& relation, double gravity) {
  Rows rows;
  for (const std::size_t i : at) {
    const Mat3 to_sensor = m.rotation[i].transpose();
    const Vec3 angular_velocity = to_sensor * m.angular_velocity[i];
    if (relation.is_direction) {
      rows.push_back({Vec3::Zero(), skew(angular_velocity)});
      continue;
    }
    const Mat3 rate_skew = skew(angular_velocity);
    rows.push_back({to_sensor * (m.acceleration[i] + Vec3(0.0, 0.0, gravity)),
                    skew(to_sensor * m.angular_acceleration[i]) + rate_skew * rate_skew});
  }
  return rows;
}

/// Parameters of the two sensors, before and after the split; equal if they are not separate.
using SplitParameters = std::array<std::array<Vec3, 2>, 2>;  // [sensor][part]

struct SplitSensors {
  bool first = false, second = false;
};

struct Fit {
  SplitParameters p;
  double rms = 0.0;  // [rad/s] or [m/s²], residuals clipped at five scales
};

class PairRelation {
 public:
  PairRelation(const Rows& a, const Rows& b, const Relation& relation)
      : rows_of_sensors_{&a, &b}, relation_(relation) {}

  Fit fit(std::size_t split, SplitSensors split_sensors) const {
    Fit best{.p = {}, .rms = std::numeric_limits<double>::infinity()};
    for (const Vec3& first : starts())
      for (const Vec3& second : starts()) {
        const Fit found = fit_from({{{first, first}, {second, second}}}, split, split_sensors);
        if (found.rms < best.rms) best = found;
      }
    return best;
  }

 private:
  std::vector<Vec3> starts() const {
    if (!relation_.is_direction) return {Vec3::Zero()};
    return {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  }

  double residual(const SplitParameters& p, std::size_t row, std::size_t part) const {
    std::array<double, 2> norm{};
    for (std::size_t s = 0; s < 2; ++s) {
      const Row& r = (*rows_of_sensors_[s])[row];
      norm[s] = (r.constant + r.jacobian * p[s][part]).norm();
    }
    return norm[0] - norm[1];
  }

  /// Rows near the split, where smoothing mixes before and after.
  static bool is_near_split(std::size_t row, std::size_t split) { return row + 2 >= split && row < split + 2; }

  double rms(const SplitParameters& p, std::size_t split) const {
    double sum = 0.0;
    for (std::size_t row = 0; row < rows_of_sensors_[0]->size(); ++row)
      if (!is_near_split(row, split))
        sum += std::pow(std::min(std::abs(residual(p, row, row >= split)), 5.0 * relation_.huber_threshold), 2);
    return std::sqrt(sum / static_cast<double>(rows_of_sensors_[0]->size()));
  }

  /// Levenberg-Marquardt with Huber's weights. Not search/least_squares: a step ends on the unit sphere and is judged
  /// by the clipped rms, and the fit ends at 1e-4 of it, so that another path gives another result.
  Fit fit_from(SplitParameters p, std::size_t split, SplitSensors split_sensors) const {
    constexpr int iterations = 12;
    Fit best{p, rms(p, split)};
    double damping = 1e-3;
    for (int i = 0; i < iterations; ++i) {
      MatrixXd matrix = MatrixXd::Zero(12, 12);
      VectorXd right = VectorXd::Zero(12);
      accumulate(best.p, split, split_sensors, matrix, right);
      matrix.diagonal() *= 1.0 + damping;
      matrix.diagonal().array() += 1e-6;
      const auto step = solve_spd(matrix, right);
      if (!step) break;
      const SplitParameters trial = updated(best.p, *step, split_sensors);
      const double error = rms(trial, split);
      const bool better = error < best.rms;
      const bool done = better && best.rms - error < 1e-4 * best.rms;
      if (better) best = {trial, error};
      damping = better ? 0.1 * damping : 10.0 * damping;
      if (done || damping > 1e6) break;
    }
    return best;
  }

  static Index column(std::size_t sensor, std::size_t part, SplitSensors split_sensors) {
    const bool own = sensor == 0 ? split_sensors.first : split_sensors.second;
    return static_cast<Index>(6 * sensor + (own ? 3 * part : 0));
  }

  void accumulate(const SplitParameters& p, std::size_t split, SplitSensors split_sensors, MatrixXd& matrix,
                  VectorXd& right) const {
    for (std::size_t row = 0; row < rows_of_sensors_[0]->size(); ++row) {
      if (is_near_split(row, split)) continue;
      const std::size_t part = row >= split;
      std::array<Vec3, 2> slope;
      std::array<double, 2> norm{};
      for (std::size_t s = 0; s < 2; ++s) {
        const Row& r = (*rows_of_sensors_[s])[row];
        const Vec3 v = r.constant + r.jacobian * p[s][part];
        norm[s] = v.norm();
        slope[s] = (s == 0 ? 1.0 : -1.0) / std::max(norm[s], 1e-9) * (r.jacobian.transpose() * v);
      }
      const double e = norm[0] - norm[1],
                   weight = std::min(1.0, relation_.huber_threshold / std::max(std::abs(e), 1e-12));
      const std::array<Index, 2> at{column(0, part, split_sensors), column(1, part, split_sensors)};
      for (std::size_t s = 0; s < 2; ++s) {
        right.segment<3>(at[s]) -= weight * e * slope[s];
        for (std::size_t k = 0; k < 2; ++k)
          matrix.block<3, 3>(at[s], at[k]) += weight * slope[s] * slope[k].transpose();
      }
    }
    for (std::size_t s = 0; s < 2; ++s)
      for (std::size_t part = 0; part < 2; ++part) {
        const Index at = column(s, part, split_sensors);
        matrix.diagonal().segment<3>(at).array() += relation_.prior_weight;
        right.segment<3>(at) -= relation_.prior_weight * p[s][part];
      }
    for (std::size_t s = 0; s < 2 && relation_.is_direction; ++s)  // unit length of directions
      for (std::size_t part = 0; part < 2; ++part) {
        const Index at = column(s, part, split_sensors);
        matrix.block<3, 3>(at, at) +=
            static_cast<double>(rows_of_sensors_[0]->size()) * p[s][part] * p[s][part].transpose();
      }
  }

  SplitParameters updated(SplitParameters p, const VectorXd& step, SplitSensors split_sensors) const {
    for (std::size_t s = 0; s < 2; ++s)
      for (std::size_t part = 0; part < 2; ++part) {
        p[s][part] += step.segment<3>(column(s, part, split_sensors));
        if (relation_.is_direction) p[s][part].normalize();
      }
    return p;
  }

  std::array<const Rows*, 2> rows_of_sensors_;
  Relation relation_;
};

/// Evidence of a pair that its first sensor was remounted at a split, with the residual rms.
struct SplitEvidence {
  std::size_t split = 0;
  bool changed = false;
  double rms = 0.0;
  double change = 0.0;  // of the sensor's direction [rad] or point [m]
};

SplitEvidence split_evidence(const PairRelation& pair, const Relation& relation, double constant_rms, double usual_rms,
                             std::size_t split) {
  const Fit own = pair.fit(split, {.first = true});
  const Vec3 &before = own.p[0][0], &after = own.p[0][1];
  const double change =
      relation.is_direction ? std::asin(std::min(1.0, before.cross(after).norm())) : (before - after).norm();
  const bool changed =
      own.rms < holding_factor * usual_rms && constant_rms > broken_factor * own.rms && change > relation.min_change;
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
      rows_.push_back({rows_of(segment, at_, gyro_relation, motion.gravity),
                       rows_of(segment, at_, force_relation, motion.gravity)});
  }

  std::optional<Remount> run() const {
    if (at_.size() < 2 * min_rows) return std::nullopt;
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

  static const Relation& relation(std::size_t k) { return k == 0 ? gyro_relation : force_relation; }

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
          if (p.relation == k && best[sensor] > broken_factor * usual_rms)
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
    const std::size_t minimum = min_rows, most = at_.size() - min_rows;
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
    constexpr double max_ratio_to_best = 1.5;
    std::size_t first = best, last = best;
    while (first > 0 && found[first].rms <= max_ratio_to_best * found[best].rms) --first;
    while (last + 1 < found.size() && found[last].rms <= max_ratio_to_best * found[best].rms) ++last;
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
      const Fit fit = pair(found.suspect.sensor, found.suspect.neighbour, k).fit(found.best, {.first = true});
      const Vec3 &before = fit.p[0][0], &after = fit.p[0][1];
      if (k == 0) remount.axis_rotation = std::asin(std::min(1.0, before.cross(after).norm()));
      if (k == 1) remount.point_shift = (before - after).norm();
    }
    return remount;
  }

  const RecordedMotion& motion_;
  std::vector<std::size_t> at_;
  int threads_;
  std::vector<std::array<Rows, 2>> rows_;  // of each segment, each relation
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
  constexpr double degrees_per_radian = 57.29577951308232;
  return {.kind = FindingKind::remounted,
          .severity = Severity::warning,
          .sentence = fmt::format("the mounting of {} changed between {:.1f} and {:.1f} s: a joint's axis turned by "
                                  "{:.1f} deg in it and the joint's point moved by about {:.0f} mm; only what was "
                                  "recorded {} is used",
                                  motion.segments[remount.segment].name, remount.begin, remount.end,
                                  degrees_per_radian * remount.axis_rotation, 1e3 * remount.point_shift,
                                  remount.before_is_more_informative ? "before" : "after"),
          .suggestion = "fix the sensor and record again, or give each part a log of its own",
          .applied = true};
}

}  // namespace kinfer::identify
