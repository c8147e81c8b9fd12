// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/fact_resolution.hpp"

#include <fmt/ranges.h>

#include <algorithm>

namespace kinfer::identify {
namespace {

struct FactResolver {
  const MachineMeasurements& facts;
  const std::vector<std::string>& sensors;
  const InsBodies& bodies;
  const SplineGrid& grid;

  std::optional<int> body_of(const std::string& sensor) const {
    for (std::size_t b = 0; b < bodies.size(); ++b)
      if (bodies[b].sensor >= 0 && sensors[static_cast<std::size_t>(bodies[b].sensor)] == sensor)
        return static_cast<int>(b);
    return {};
  }

  /// The body of the joint that carries `body`; of a joint with several axes, the first.
  int first_body_of_joint(int body) const {
    while (true) {
      const int parent = bodies[static_cast<std::size_t>(body)].parent;
      if (parent < 0 || bodies[static_cast<std::size_t>(parent)].sensor >= 0) return body;
      body = parent;
    }
  }

  std::string joint_name(int body) const {
    const InsBody& first = bodies[static_cast<std::size_t>(first_body_of_joint(body))];
    const int before = bodies[static_cast<std::size_t>(first.parent)].sensor;
    return fmt::format("{}-{}", sensors[static_cast<std::size_t>(before)],
                       sensors[static_cast<std::size_t>(bodies[static_cast<std::size_t>(body)].sensor)]);
  }

  Result<InsPoint> point(const std::string& name) const {
    const auto place = std::ranges::find(facts.places, name, &SegmentPoint::name);
    if (place != facts.places.end()) {
      const auto body = body_of(place->sensor);
      if (!body) return error("place {}: no sensor is called \"{}\"", name, place->sensor);
      return InsPoint{InsPoint::Kind::place, *body, static_cast<int>(place - facts.places.begin())};
    }
    if (const auto body = body_of(name)) return InsPoint{InsPoint::Kind::sensor, *body};
    std::vector<std::string> joints;
    for (std::size_t b = 1; b < bodies.size(); ++b) {
      if (bodies[b].sensor < 0) continue;
      joints.push_back(joint_name(static_cast<int>(b)));
      if (joints.back() != name) continue;
      const int first = first_body_of_joint(static_cast<int>(b));
      if (bodies[b].motion == JointMotion::fixed || bodies[b].motion == JointMotion::prismatic)
        return error("{}: only joints that rotate have a point for a tape measurement", name);
      const bool has_one_axis = bodies[b].motion == JointMotion::revolute && first == static_cast<int>(b);
      return InsPoint{has_one_axis ? InsPoint::Kind::joint_axis : InsPoint::Kind::joint_centre, first};
    }
    return error("no sensor, joint or [[place]] is called \"{}\"; the joints are {}", name, fmt::join(joints, ", "));
  }

  Result<double> time(const HoldSegment& window) const {
    const double middle = 0.5 * (window.begin + window.end);
    if (window.begin < grid.begin || window.end > grid.end())
      return error("{:g} .. {:g} s: outside the recording, which spans {:.2f} .. {:.2f} s", window.begin, window.end,
                   grid.begin, grid.end());
    return middle;
  }
};

Result<InsRevisitedPoint> resolve(const TouchMeasurement& fact, const FactResolver& names) {
  KINFER_TRY(point, names.point(fact.point));
  InsRevisitedPoint touch{point, {}, fact.sigma};
  for (const HoldSegment& window : fact.at) {
    KINFER_TRY(time, names.time(window));
    touch.at.push_back(time);
  }
  return touch;
}

Result<InsTapeDistance> resolve(const TapeMeasurement& fact, const FactResolver& names) {
  KINFER_TRY(from, names.point(fact.from));
  KINFER_TRY(to, names.point(fact.to));
  InsTapeDistance tape{from, to, fact.length, fact.sigma, names.grid.begin};
  if (fact.at) {
    KINFER_TRY(time, names.time(*fact.at));
    tape.at = time;
  }
  return tape;
}

Result<InsSurveyedPoint> resolve(const SurveyMeasurement& fact, const FactResolver& names) {
  KINFER_TRY(point, names.point(fact.point));
  KINFER_TRY(time, names.time(fact.at));
  return InsSurveyedPoint{point, time, fact.xyz, fact.sigma};
}

template <class Resolved, class Fact>
Result<std::vector<Resolved>> resolve_all(const std::vector<Fact>& facts, const char* kind, const FactResolver& names) {
  std::vector<Resolved> all;
  for (const Fact& fact : facts) {
    const auto one = resolve(fact, names);
    if (!one) return error("{} {}: {}", kind, all.size() + 1, one.error().what);
    all.push_back(*one);
  }
  return all;
}

}  // namespace

Result<InsFacts> resolve_facts(const MachineMeasurements& facts, const std::vector<std::string>& sensors,
                               const InsBodies& bodies, const SplineGrid& grid, bool root_at_rest) {
  const FactResolver names{facts, sensors, bodies, grid};
  if (!root_at_rest && !(facts.touches.empty() && facts.surveys.empty()))
    return error("touches and surveyed points need a machine with a stationary base");
  if (!facts.surveys.empty() && facts.surveys.size() < 3)
    return error("{} surveyed point{}: at least 3 are needed to place the surveyor's frame", facts.surveys.size(),
                 facts.surveys.size() == 1 ? "" : "s");
  InsFacts all;
  for (const SegmentPoint& place : facts.places) {
    KINFER_TRY(point, names.point(place.name));
    InsUnknownPoint known{.body = point.body};
    if (place.xyz) known.start = *place.xyz, known.sd = place.sigma;
    all.places.push_back(known);
  }
  KINFER_TRY(touches, resolve_all<InsRevisitedPoint>(facts.touches, "touch", names));
  KINFER_TRY(tapes, resolve_all<InsTapeDistance>(facts.tapes, "tape", names));
  KINFER_TRY(surveyed, resolve_all<InsSurveyedPoint>(facts.surveys, "point", names));
  all.touches = std::move(touches);
  all.tapes = std::move(tapes);
  all.surveyed = std::move(surveyed);
  return all;
}

}  // namespace kinfer::identify
