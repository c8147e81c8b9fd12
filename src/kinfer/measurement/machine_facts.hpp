// What is known about a machine besides its INS recording: a tape, touches, surveyed points.
//
// Points of a machine are named: a sensor ("ins2": its origin), a joint ("ins1-ins2": its axis line, or its centre
// where it is spherical), or a place that the facts themselves define ("tip", fixed to a sensor's segment).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

/// A stretch of the recording in which the machine holds a pose.
struct HoldWindow {
  double begin = 0.0, end = 0.0;  ///< [s] on the clock of the first log
};

/// A place on a segment, as the tool's tip beyond the last sensor.
struct PlaceFact {
  std::string name, sensor;
  std::optional<Vec3> xyz;  ///< [m] in the sensor's frame; absent: unknown, to be found from the other facts
  double sigma = 0.0;       ///< [m] per axis, where xyz is given
};

/// The point was at one and the same place of the world in all these windows, which is not known.
struct TouchFact {
  std::string point;
  std::vector<HoldWindow> at;  ///< two or more
  double sigma = 0.0;          ///< [m] per axis
};

/// A distance between two points. Between pins: the shortest one of their axis lines.
struct TapeFact {
  std::string from, to;
  double length = 0.0, sigma = 0.0;  ///< [m]
  std::optional<HoldWindow> at;      ///< needed where joints move between the points
};

/// The point was here, in a surveyor's frame that stands still beside the machine; where that frame is, is not known.
struct SurveyFact {
  std::string point;
  HoldWindow at;
  Vec3 xyz = Vec3::Zero();  ///< [m] in the surveyor's frame
  double sigma = 0.0;       ///< [m] per axis
};

struct MachineFacts {
  std::vector<PlaceFact> places;
  std::vector<TouchFact> touches;
  std::vector<TapeFact> tapes;
  std::vector<SurveyFact> surveys;

  bool empty() const { return touches.empty() && tapes.empty() && surveys.empty() && places.empty(); }
};

}  // namespace kinfer
