// How the variables of a joint of the found chain moved, by the splines of the continuous-time fit.
#pragma once

#include "kinfer/estimate/uniform_spline.hpp"
#include "kinfer/identify/refined_joint.hpp"

namespace kinfer {

/// One row a variable of the joint, in the order of joint_axes, one column a time [rad] or [m]. `bodies`: as
/// refined_joint was given them. `coefficients`: of their readings' splines, one row a freedom.
MatrixXd joint_film(FoundJointType type, std::span<const InsBody> bodies, const HingeGeometry& geometry,
                    const SplineGrid& grid, ConstMatrixRef coefficients, std::span<const double> times);

/// Directions in the parent that a ball turns about one by one, most of all about the first and least about the
/// second, which must stay within a quarter turn. `turns`: rotation vectors against home in the parent, 3 x times.
Mat3 ball_axes(ConstMatrixRef turns);

/// Rotation vectors of a ball against where the recording begins, 3 x times.
MatrixXd ball_turns(const SplineGrid& grid, ConstMatrixRef coefficients, std::span<const double> times);

/// Angles of R = Rx(q0) Ry(q1) Rz(q2), of the two solutions the one nearer to `before`, whole turns included.
Vec3 cardan_angles(const Mat3& r, const Vec3& before);

}  // namespace kinfer
