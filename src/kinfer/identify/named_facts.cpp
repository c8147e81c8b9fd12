#include "kinfer/identify/named_facts.hpp"

#include <fmt/ranges.h>

#include <algorithm>

namespace kinfer {
namespace {

struct Names {
  const MachineFacts& facts;
  const std::vector<std::string>& sensors;
  const InsBodies& bodies;
  const SplineGrid& grid;

  std::optional<int> body_of(const std::string& sensor) const {
    for (std::size_t b = 0; b < bodies.size(); ++b)
      if (bodies[b].sensor >= 0 && sensors[static_cast<std::size_t>(bodies[b].sensor)] == sensor)
        return static_cast<int>(b);
    return {};
  }

  /// The joint that the body hangs on; where it turns about several axes, the first of them.
  int first_of_joint(int body) const {
    while (true) {
      const int parent = bodies[static_cast<std::size_t>(body)].parent;
      if (parent < 0 || bodies[static_cast<std::size_t>(parent)].sensor >= 0) return body;
      body = parent;
    }
  }

  std::string joint_name(int body) const {
    const InsBody& first = bodies[static_cast<std::size_t>(first_of_joint(body))];
    const int before = bodies[static_cast<std::size_t>(first.parent)].sensor;
    return fmt::format("{}-{}", sensors[static_cast<std::size_t>(before)],
                       sensors[static_cast<std::size_t>(bodies[static_cast<std::size_t>(body)].sensor)]);
  }

  Result<InsPoint> point(const std::string& name) const {
    const auto place = std::ranges::find(facts.places, name, &PlaceFact::name);
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
      const int first = first_of_joint(static_cast<int>(b));
      if (bodies[b].motion != JointMotion::turn)
        return error("{}: only joints that turn have a place that a tape can find", name);
      const bool is_hinge = first == static_cast<int>(b);
      return InsPoint{is_hinge ? InsPoint::Kind::joint_axis : InsPoint::Kind::joint_centre, first};
    }
    return error("no sensor, joint or [[place]] is called \"{}\"; the joints are {}", name, fmt::join(joints, ", "));
  }

  Result<double> time(const HoldWindow& window) const {
    const double middle = 0.5 * (window.begin + window.end);
    if (window.begin < grid.begin || window.end > grid.end())
      return error("{:g} .. {:g} s: outside the recording, which spans {:.2f} .. {:.2f} s", window.begin, window.end,
                   grid.begin, grid.end());
    return middle;
  }
};

Result<InsTouch> named(const TouchFact& fact, const Names& names) {
  KINFER_TRY(point, names.point(fact.point));
  InsTouch touch{point, {}, fact.sigma};
  for (const HoldWindow& window : fact.at) {
    KINFER_TRY(time, names.time(window));
    touch.at.push_back(time);
  }
  return touch;
}

Result<InsTape> named(const TapeFact& fact, const Names& names) {
  KINFER_TRY(from, names.point(fact.from));
  KINFER_TRY(to, names.point(fact.to));
  InsTape tape{from, to, fact.length, fact.sigma, names.grid.begin};
  if (fact.at) {
    KINFER_TRY(time, names.time(*fact.at));
    tape.at = time;
  }
  return tape;
}

Result<InsSurveyed> named(const SurveyFact& fact, const Names& names) {
  KINFER_TRY(point, names.point(fact.point));
  KINFER_TRY(time, names.time(fact.at));
  return InsSurveyed{point, time, fact.xyz, fact.sigma};
}

template <class Named, class Fact>
Result<std::vector<Named>> all_named(const std::vector<Fact>& facts, const char* kind, const Names& names) {
  std::vector<Named> all;
  for (const Fact& fact : facts) {
    const auto one = named(fact, names);
    if (!one) return error("{} {}: {}", kind, all.size() + 1, one.error().what);
    all.push_back(*one);
  }
  return all;
}

}  // namespace

Result<InsFacts> named_facts(const MachineFacts& facts, const std::vector<std::string>& sensors,
                             const InsBodies& bodies, const SplineGrid& grid, bool root_stands_still) {
  const Names names{facts, sensors, bodies, grid};
  if (!root_stands_still && !(facts.touches.empty() && facts.surveys.empty()))
    return error("touches and surveyed points need a machine whose base stands still");
  if (!facts.surveys.empty() && facts.surveys.size() < 3)
    return error("{} surveyed point{}: at least 3 are needed to place the surveyor's frame", facts.surveys.size(),
                 facts.surveys.size() == 1 ? "" : "s");
  InsFacts all;
  for (const PlaceFact& place : facts.places) {
    KINFER_TRY(point, names.point(place.name));
    InsPlace known{.body = point.body};
    if (place.xyz) known.start = *place.xyz, known.sd = place.sigma;
    all.places.push_back(known);
  }
  KINFER_TRY(touches, all_named<InsTouch>(facts.touches, "touch", names));
  KINFER_TRY(tapes, all_named<InsTape>(facts.tapes, "tape", names));
  KINFER_TRY(surveyed, all_named<InsSurveyed>(facts.surveys, "point", names));
  all.touches = std::move(touches);
  all.tapes = std::move(tapes);
  all.surveyed = std::move(surveyed);
  return all;
}

}  // namespace kinfer
