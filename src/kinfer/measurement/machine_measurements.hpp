// SPDX-License-Identifier: Apache-2.0
// Measurements of a machine in addition to its INS recording: tape measurements, touched points, surveyed points.
//
// Points of a machine are named: a sensor ("ins2": its origin), a joint ("ins1-ins2": its axis, or its centre if it is
// spherical), or a point that the file itself defines ("tip", fixed to a sensor's segment).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

/// A time segment of the recording in which the machine holds a pose.
struct HoldSegment {
  double begin = 0.0, end = 0.0;  ///< [s] on the clock of the first log
};

/// A point on a segment, such as the tool tip beyond the last sensor.
struct SegmentPoint {
  std::string name, sensor;
  std::optional<Vec3> xyz;  ///< [m] in the sensor's frame; absent: unknown, estimated from the other measurements
  double sigma = 0.0;       ///< [m] per axis, where xyz is given
};

/// The point was at the same, unknown world position in all these time windows.
struct TouchMeasurement {
  std::string point;
  std::vector<HoldSegment> at;  ///< two or more
  double sigma = 0.0;           ///< [m] per axis
};

/// A distance between two points; between two joints, the shortest distance of their axes.
struct TapeMeasurement {
  std::string from, to;
  double length = 0.0, sigma = 0.0;  ///< [m]
  std::optional<HoldSegment> at;     ///< required if there are joints between the points
};

/// Position of a point in the surveyor's frame, which is fixed in the world; its pose there is unknown.
struct SurveyMeasurement {
  std::string point;
  HoldSegment at;
  Vec3 xyz = Vec3::Zero();  ///< [m] in the surveyor's frame
  double sigma = 0.0;       ///< [m] per axis
};

struct MachineMeasurements {
  std::vector<SegmentPoint> places;
  std::vector<TouchMeasurement> touches;
  std::vector<TapeMeasurement> tapes;
  std::vector<SurveyMeasurement> surveys;

  bool empty() const { return touches.empty() && tapes.empty() && surveys.empty() && places.empty(); }
};

}  // namespace kinfer
