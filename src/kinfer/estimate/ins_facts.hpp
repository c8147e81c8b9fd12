// What is known about a machine besides its recording, in the terms of the continuous-time fit: touches, tapes and
// surveyed points, each a few more residuals at one time.
#pragma once

#include <vector>

#include "kinfer/geometry/pose.hpp"

namespace kinfer {

/// A point, or an axis line, that moves with a body.
struct InsPoint {
  enum class Kind { sensor, joint_centre, joint_axis, place };
  Kind kind = Kind::sensor;
  int body = 0;    ///< that carries it; of a joint: the body that hangs on it
  int place = -1;  ///< index into InsFacts::places
};

/// A point in the frame of a body's sensor that is itself to be found.
struct InsPlace {
  int body = 0;
  Vec3 start = Vec3::Zero();  ///< [m] prior mean
  double sd = 3.0;            ///< [m] per axis, of the prior
};

/// The point was at one unknown place beside the root at these times.
struct InsTouch {
  InsPoint point;
  std::vector<double> at;  ///< [s]
  double sd = 0.0;         ///< [m] per axis
};

/// The shortest distance between two points or lines.
struct InsTape {
  InsPoint from, to;
  double length = 0.0, sd = 0.0;  ///< [m]
  double at = 0.0;                ///< [s]
};

/// The point was here in a surveyor's frame, which stands still beside the root.
struct InsSurveyed {
  InsPoint point;
  double at = 0.0;          ///< [s]
  Vec3 xyz = Vec3::Zero();  ///< [m] in the surveyor's frame
  double sd = 0.0;          ///< [m] per axis
};

struct InsFacts {
  std::vector<InsPlace> places;
  std::vector<InsTouch> touches;
  std::vector<InsTape> tapes;
  std::vector<InsSurveyed> surveyed;
};

/// What facts make unknown: 3 a place, 3 a touch, 6 the surveyor's frame if there is one.
struct InsFactUnknowns {
  std::vector<Vec3> places;   ///< [m] in the sensor's frame
  std::vector<Vec3> touched;  ///< [m] in the root's frame
  Pose surveyor;              ///< root_T_surveyor
};

}  // namespace kinfer
