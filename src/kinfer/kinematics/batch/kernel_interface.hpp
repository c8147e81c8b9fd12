// SPDX-License-Identifier: Apache-2.0
// Interface of the batch kernels: plain structs and pointers, so that a kernel file compiled for one instruction set
// shares no inline function with the rest of the program.
//
// A chain is split into segments: a constant transform, then the rotation of a joint about z of the current frame or
// its translation along it, and so on to the tool. "Constant": the same at all poses, for a given candidate.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kinfer/kinematics/batch/pose_job.hpp"
#include "kinfer/linalg/kernels/gram_jobs.hpp"

namespace kinfer::batch {

/// A number of the chain: parameter x[parameter], or a constant where that is negative.
struct Value {
  int parameter = -1;
  int angle = -1;               ///< index among the parameters that are angles; -1: is none
  double constant = 0.0;        ///< nominal value where there is a parameter
  double cos = 1.0, sin = 0.0;  ///< of the constant, where it is an angle
};

/// One candidate parameter vector. `angles`: the parameters that are angles, whose sines are needed.
struct Candidate {
  const double* x = nullptr;
  const int* angles = nullptr;
  int angle_count = 0;
};
/// Workspace for the sines of a candidate, in doubles.
[[gnu::always_inline]] constexpr std::size_t sines_workspace(int angles, int lanes) {
  return static_cast<std::size_t>(3 * (angles + lanes));
}

/// A rotation about or a translation along one axis; or a constant rotation matrix (row-major).
struct Factor {
  enum class Kind : std::uint8_t { axis_rotation, axis_translation, constant_rotation };
  Kind kind = Kind::axis_rotation;
  int axis = 0;
  Value value;
  double rotation[9] = {};
};

enum class Shape : std::uint8_t {
  identity,
  link,     ///< TransZ(d) TransX(a) RotX(alpha) RotZ(theta): r02 = ty = 0
  general,  ///< any rotation and translation
};

/// Joint motion after the constant transform. By gain: the gain of the candidate may differ from the nominal one that
/// the joint displacements were computed with.
enum class MotionKind : std::uint8_t { none, revolute, prismatic, revolute_with_gain, prismatic_with_gain };

/// A constant transform [r00 r01 r02 tx; r10 r11 r12 ty; r20 r21 r22 tz], and the joint motion after it.
struct Segment {
  Shape shape = Shape::identity;
  bool varies = false;    ///< with the candidate
  bool in_sheet = false;  ///< a link that varies: for one candidate, it is evaluated together with others
  double numbers[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  Value d, a, alpha, theta;         ///< of a link that varies
  const Factor* factors = nullptr;  ///< of a general transform that varies
  int factor_count = 0;
  MotionKind move = MotionKind::none;
  Value gain;            ///< of a motion by gain: x[parameter] − constant is the change of the gain
  int slots_before = 0;  ///< numbers of an item that belong to the joint motions further outwards
};

/// One DH number of each link of a sheet.
inline constexpr int links_per_sheet = 8;
struct SheetColumn {
  int parameter[links_per_sheet] = {};    ///< arbitrary where it is not free
  double is_free[links_per_sheet] = {};   ///< all bits set or none
  double constant[links_per_sheet] = {};  ///< as of a Value
  double cos[links_per_sheet] = {1, 1, 1, 1, 1, 1, 1, 1}, sin[links_per_sheet] = {};
};
/// Segments 8 k .. 8 k + 7, one per lane; those that are not links are ignored here.
struct LinkSheet {
  SheetColumn d, a, alpha, theta;
};

/// Items that are the same point of the tool.
struct Group {
  int begin = 0, end = 0;  ///< items
  double on_tool[3] = {};
  bool on_last_axis = false;  ///< the last joint axis goes through the point: the joint does not move it
};

/// Sums of squared errors of candidates: lanes are candidates. An item is a measured point: for each joint motion from
/// the tip inwards cosine and sine, or length, and by gain the joint position; then the measured coordinates.
template <class T>
struct PopulationJob {
  const Segment* segments = nullptr;
  int segment_count = 0;
  const Group* groups = nullptr;
  int group_count = 0;
  const T* items = nullptr;
  int stride = 0;  ///< numbers of an item
  int unknowns = 0;
  const double* nominal = nullptr;  ///< of each unknown
  const int* angles = nullptr;      ///< unknowns that are angles
  int angle_count = 0;
  const double* x = nullptr;  ///< unknowns x candidates, column by column
  std::ptrdiff_t x_stride = 0;
  int candidates = 0;
  double* sums = nullptr;
  T* workspace = nullptr;  ///< lanes · (unknowns + 13 segment_count)
};

/// Workspace that a PointsJob needs, in doubles.
[[gnu::always_inline]] constexpr std::size_t points_workspace(int angles, int segments, int lanes) {
  return sines_workspace(angles, lanes) + static_cast<std::size_t>(13 * (segments + links_per_sheet));
}

/// Errors of points for one candidate: lanes are points, in blocks of one point per lane.
struct PointsJob {
  const Segment* segments = nullptr;
  int segment_count = 0;
  const LinkSheet* sheets = nullptr;  ///< null: no segment is in a sheet
  const Group* groups = nullptr;      ///< items are blocks
  int group_count = 0;
  const double* items = nullptr;  ///< block by block, number by number, lane by lane
  int stride = 0;
  Candidate at;              ///< only angles of segments that are in no sheet
  double* errors = nullptr;  ///< measured − predicted, 3 x lanes a block
  double* workspace = nullptr;
};

/// A rotation about and a translation along one axis, which commute; or a constant rotation. Joint motions are about or
/// along z. The column of a parameter has the index of the parameter.
struct Screw {
  bool is_rotation = false;
  int axis = 0;
  Value angle{}, length{};
  MotionKind move = MotionKind::none;
  Value gain{};   ///< as of a Segment
  int slot = -1;  ///< of the joint motion's numbers in an item
  double rotation[9] = {};
};

struct JacobianJob {
  const Screw* screws = nullptr;  ///< from the world to the tool
  int screw_count = 0;
  Candidate at;
  const Group* groups = nullptr;  ///< items are blocks
  int group_count = 0;
  const double* items = nullptr;  ///< as of a PointsJob
  int stride = 0;
  const double* weights = nullptr;  ///< 3 x lanes a block, 1 / sd; 0 where a lane has no point
  int columns = 0;
  const int* idle = nullptr;  ///< columns that no screw writes
  int idle_count = 0;
  int blocks = 0;
  double* jacobian = nullptr;   ///< d residuals: column by column, each 3 x lanes a block; null: normal equations
  double* residuals = nullptr;  ///< with a Jacobian: weight · (measured − predicted), 3 x lanes a block
  double* matrix = nullptr;     ///< without: lower half of JᵀJ, column by column
  double* gradient = nullptr;   ///< likewise: Jᵀr
  double* workspace = nullptr;
};

inline constexpr int blocks_in_flight = 2, blocks_per_chunk = 8;
[[gnu::always_inline]] constexpr Chunks chunks_of(int blocks) {
  return blocks > blocks_per_chunk ? Chunks::several : Chunks::one;
}
/// Workspace that a JacobianJob needs, in doubles.
[[gnu::always_inline]] constexpr std::size_t jacobian_workspace(int columns, int screws, int blocks, int lanes) {
  return static_cast<std::size_t>(
      screws * (4 + 4 * blocks_in_flight * lanes) + lanes + padded_columns(columns) * 3 * blocks_per_chunk * lanes +
      tile_numbers(columns, chunks_of(blocks), lanes) + round_up(columns, strip_width) * lanes);
}

/// The functions of one kernel file.
struct Kernels {
  const char* name = nullptr;
  int lanes = 0, float_lanes = 0;
  void (*sums)(const PopulationJob<double>&) = nullptr;
  void (*float_sums)(const PopulationJob<float>&) = nullptr;
  void (*sines)(const double* angles, int count, double* cosines, double* sines) = nullptr;
  void (*errors)(const PointsJob&) = nullptr;
  double (*jacobian)(const JacobianJob&) = nullptr;  ///< returns the sum of the squared residuals
  void (*poses)(const PoseJob&) = nullptr;
};

extern const Kernels portable_kernels;
#if defined(__x86_64__)
extern const Kernels avx2_kernels, avx512_kernels;
#endif

/// The fastest kernels that this processor supports.
const Kernels& best_kernels();

/// All kernels that this processor supports, the portable ones first.
struct KernelList {
  const Kernels* kernels[3] = {};
  int count = 0;
};
KernelList runnable_kernels();

}  // namespace kinfer::batch
