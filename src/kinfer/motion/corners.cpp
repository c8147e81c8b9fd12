// SPDX-License-Identifier: Apache-2.0
#include "kinfer/motion/corners.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/motion/thresholds.hpp"

namespace kinfer::motion {
namespace {

using Eigen::Index;

/// The lines between the first waypoint and the last.
struct Lines {
  std::vector<VectorXd> ways;       // [rad] or [m] of each joint
  std::vector<MotionLimits> along;  // of the part of the line
  const std::vector<MotionLimits>& joints;
  const VectorXd& units;  // of cuts

  std::size_t count() const { return along.size(); }

  /// Round a waypoint, with these parts of the velocities of its two lines.
  Corner corner(std::size_t waypoint, double before, double after) const {
    Corner corner{before * along[waypoint - 1].velocity, after * along[waypoint].velocity};
    const VectorXd change = change_of_velocity(corner, ways[waypoint - 1], ways[waypoint]);
    if (change.isZero(0.0)) return corner;
    corner.ramp = fastest_ramp(1.0, limits_along(change, joints));
    const double duration = corner.ramp.duration();
    corner.cut = corner.ramp.at(0.5 * duration).position * duration * change.cwiseQuotient(units).cwiseAbs().maxCoeff();
    return corner;
  }

  /// With speeds multiplied by these factors, as far as the limits allow.
  Corner scaled(std::size_t waypoint, const Corner& from, double before, double after) const {
    return corner(waypoint, std::min(1.0, before * from.before / along[waypoint - 1].velocity),
                  std::min(1.0, after * from.after / along[waypoint].velocity));
  }
};

Lines lines_through(const MatrixXd& waypoints, const std::vector<MotionLimits>& limits, const VectorXd& units) {
  Lines lines{{}, {}, limits, units};
  for (Index k = 0; k + 1 < waypoints.cols(); ++k) {
    lines.ways.push_back(waypoints.col(k + 1) - waypoints.col(k));
    lines.along.push_back(limits_along(lines.ways.back(), limits));
  }
  return lines;
}

/// Part of a line that the ramp of a corner at its end needs.
double part_of_line(const Corner& corner, double speed) {
  return 0.5 * corner.ramp.duration() * speed;
}

/// The largest part of 1 with which the condition holds, or 0.
template <class Condition>
double largest_part(Condition holds) {
  if (holds(1.0)) return 1.0;
  double low = 0.0, high = 1.0;
  while (high > thresholds::least_corner_speed && high - low > 1e-3 * high) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? low : high) = middle;
  }
  return low;
}

/// Of each waypoint: the part of the velocities with which its corner fits its lines and can be reached from rest.
std::vector<double> largest_parts(const Lines& lines) {
  std::vector<double> parts(lines.count() + 1, 0.0);
  const auto follows = [&](std::size_t line, double from, double to) {
    const MotionLimits& along = lines.along[line];
    const double change = along.velocity * (to - from);
    return to <= from || 0.5 * along.velocity * (from + to) * fastest_ramp(change, along).duration() <= 1.0;
  };
  for (std::size_t w = 1; w < lines.count(); ++w)
    parts[w] = largest_part([&](double part) {
      const Corner corner = lines.corner(w, part, part);
      return part_of_line(corner, std::max(corner.before, corner.after)) <= 1.0 && follows(w - 1, parts[w - 1], part);
    });
  for (std::size_t w = lines.count(); w-- > 1;) {
    const double most = parts[w];
    parts[w] = most * largest_part([&](double part) { return follows(w, parts[w + 1], part * most); });
  }
  return parts;
}

using Choices = std::vector<std::vector<Corner>>;  // of each waypoint

/// The quickest of all combinations.
std::vector<Corner> quickest(const Lines& lines, const Choices& choices) {
  std::vector<std::vector<std::size_t>> comes_from(choices.size());
  std::vector<double> times(choices.front().size(), 0.0);
  for (std::size_t line = 0; line < lines.count(); ++line) {
    const std::vector<Corner>&corners = choices[line], &nexts = choices[line + 1];
    std::vector<double> next_times(nexts.size(), std::numeric_limits<double>::infinity());
    comes_from[line + 1].assign(nexts.size(), 0);
    for (std::size_t b = 0; b < nexts.size(); ++b)
      for (std::size_t a = 0; a < corners.size(); ++a) {
        const double left = 1.0 - part_of_line(corners[a], corners[a].after) - part_of_line(nexts[b], nexts[b].before);
        const double until = times[a] + nexts[b].ramp.duration();
        if (!(left >= 0.0 && until + left / lines.along[line].velocity < next_times[b])) continue;
        const double time = until + profile_between(corners[a], nexts[b], lines.along[line]).duration;
        if (time < next_times[b]) next_times[b] = time, comes_from[line + 1][b] = a;
      }
    times = std::move(next_times);
  }
  std::vector<Corner> chosen(choices.size());
  std::size_t choice = 0;  // the last waypoint has one
  for (std::size_t w = choices.size(); w-- > 0;) {
    chosen[w] = choices[w][choice];
    if (w > 0) choice = comes_from[w][choice];
  }
  return chosen;
}

/// These corners, slowed down in geometric steps.
void add_steps(Choices& choices, const Lines& lines, const std::vector<Corner>& corners) {
  for (std::size_t w = 1; w < lines.count(); ++w)
    for (int i = 0; i < thresholds::corner_steps && corners[w].before > 0.0; ++i) {
      const double part = std::exp2(-i / thresholds::corner_steps_per_octave);
      choices[w].push_back(lines.scaled(w, corners[w], part, part));
    }
}

/// Quicker corners near these, found in ever smaller steps; the two velocities of each by steps of their own.
std::vector<Corner> refined(const Lines& lines, std::vector<Corner> corners) {
  for (double octaves = thresholds::largest_corner_change; octaves > thresholds::least_corner_change; octaves *= 0.7) {
    Choices choices(corners.size(), std::vector<Corner>(1));
    for (std::size_t w = 1; w < lines.count(); ++w)
      for (int i = -1; i <= 1 && corners[w].before > 0.0; ++i)
        for (int j = -1; j <= 1; ++j)
          choices[w].push_back(lines.scaled(w, corners[w], std::exp2(i * octaves), std::exp2(j * octaves)));
    corners = quickest(lines, choices);
  }
  return corners;
}

}  // namespace

VectorXd change_of_velocity(const Corner& corner, const VectorXd& before, const VectorXd& after) {
  return corner.after * after - corner.before * before;
}

LineProfile profile_between(const Corner& corner, const Corner& next, const MotionLimits& line) {
  const double left = 1.0 - part_of_line(corner, corner.after) - part_of_line(next, next.before);
  return quickest_profile(left, corner.after, next.before, line);
}

std::vector<Corner> quickest_corners(const MatrixXd& waypoints, const std::vector<MotionLimits>& limits,
                                     double most_cut, const VectorXd& units) {
  const Lines lines = lines_through(waypoints, limits, units);
  Choices choices(lines.count() + 1, std::vector<Corner>(1));
  if (lines.count() == 1) return quickest(lines, choices);
  const std::vector<double> parts = largest_parts(lines);
  std::vector<Corner> largest(parts.size());
  for (std::size_t w = 1; w < lines.count(); ++w) largest[w] = lines.corner(w, parts[w], parts[w]);
  // Both lists are the same for all sizes of the corner: what a smaller one allows stays a choice for a larger one.
  add_steps(choices, lines, largest);
  add_steps(choices, lines, refined(lines, quickest(lines, choices)));
  for (std::vector<Corner>& of : choices) std::erase_if(of, [&](const Corner& c) { return c.cut > most_cut; });
  return quickest(lines, choices);
}

}  // namespace kinfer::motion
