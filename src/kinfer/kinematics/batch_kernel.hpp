// What the batch kernels are told and what they offer: plain numbers, so that a kernel file compiled for one
// instruction set shares no inline function with the rest of the program.
//
// A chain is folded into segments: a constant transform, then a joint's turn about or shift along z of the frame
// reached, and so on to the tool. "Constant" means the same at all poses; it may differ from candidate to candidate.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kinfer/linalg/gram_plan.hpp"

namespace kinfer::batch {

/// A number of the chain: parameter x[parameter], or a constant where that is negative.
struct Value {
  int parameter = -1;
  int angle = -1;               ///< of a parameter that is an angle: which one of them
  double constant = 0.0;        ///< of a parameter: its nominal number
  double cos = 1.0, sin = 0.0;  ///< of the constant, where it is an angle
};

/// One candidate. `angles` are the parameters that are angles: only their sines are taken.
struct Candidate {
  const double* x = nullptr;
  const int* angles = nullptr;
  int angle_count = 0;
};
/// Numbers of workspace for the sines of a candidate.
[[gnu::always_inline]] constexpr std::size_t sines_workspace(int angles, int lanes) {
  return static_cast<std::size_t>(3 * (angles + lanes));
}

/// A turn about or a shift along one axis; or a constant rotation (row by row).
struct Factor {
  enum class Kind : std::uint8_t { turn, shift, rotation };
  Kind kind = Kind::turn;
  int axis = 0;
  Value value;
  double rotation[9] = {};
};

enum class Shape : std::uint8_t {
  identity,
  link,     ///< TransZ(d) TransX(a) RotX(alpha) RotZ(theta): r02 = ty = 0
  general,  ///< any rotation and shift
};

/// What follows a segment's constant. The candidate's gain may differ from the one that the movements were made with.
enum class Move : std::uint8_t { none, turn, shift, turn_by_gain, shift_by_gain };

/// A constant transform [r00 r01 r02 tx; r10 r11 r12 ty; r20 r21 r22 tz], and the movement after it.
struct Segment {
  Shape shape = Shape::identity;
  bool varies = false;    ///< with the candidate
  bool in_sheet = false;  ///< a link that varies: for one candidate it is folded beside others
  double numbers[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  Value d, a, alpha, theta;         ///< of a link that varies
  const Factor* factors = nullptr;  ///< of a general transform that varies
  int factor_count = 0;
  Move move = Move::none;
  Value gain;            ///< of a movement by gain: x[parameter] − constant is what changed
  int slots_before = 0;  ///< numbers of an item that belong to the movements further outwards
};

/// One number of each link of a sheet.
inline constexpr int links_a_sheet = 8;
struct SheetColumn {
  int parameter[links_a_sheet] = {};    ///< any where none is free
  double is_free[links_a_sheet] = {};   ///< all bits set or none
  double constant[links_a_sheet] = {};  ///< as of a Value
  double cos[links_a_sheet] = {1, 1, 1, 1, 1, 1, 1, 1}, sin[links_a_sheet] = {};
};
/// Segments 8 k .. 8 k + 7 side by side: those that are not links are left to others.
struct LinkSheet {
  SheetColumn d, a, alpha, theta;
};

/// Points that start at the same place of the tool.
struct Group {
  int begin = 0, end = 0;  ///< items
  double on_tool[3] = {};
  bool on_last_axis = false;  ///< the last joint turns about the point: it and the constant before it move no item
};

/// Sums of squared errors of candidates: lanes are candidates. An item is a point: for each movement from the tip
/// inwards cosine and sine, or length and nothing, and by gain the reading; then where the point was measured.
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

/// Numbers of workspace that a PointsJob needs.
[[gnu::always_inline]] constexpr std::size_t points_workspace(int angles, int segments, int lanes) {
  return sines_workspace(angles, lanes) + static_cast<std::size_t>(13 * (segments + links_a_sheet));
}

/// Errors of points at one candidate: lanes are points, in blocks of as many.
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

/// A turn about and a shift along one axis, which commute; or a constant rotation. A movement is about or along z. The
/// column of a parameter has its number.
struct Screw {
  bool is_rotation = false;
  int axis = 0;
  Value turn{}, shift{};
  Move move = Move::none;
  Value gain{};   ///< as of a Segment
  int slot = -1;  ///< of the movement's numbers in an item
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

inline constexpr int blocks_in_flight = 2, blocks_a_chunk = 8;
[[gnu::always_inline]] constexpr Chunks chunks_of(int blocks) {
  return blocks > blocks_a_chunk ? Chunks::several : Chunks::one;
}
/// Numbers of workspace that a JacobianJob needs.
[[gnu::always_inline]] constexpr std::size_t jacobian_workspace(int columns, int screws, int blocks, int lanes) {
  return static_cast<std::size_t>(
      screws * (4 + 4 * blocks_in_flight * lanes) + lanes + padded_columns(columns) * 3 * blocks_a_chunk * lanes +
      tile_numbers(columns, chunks_of(blocks), lanes) + round_up(columns, strip_width) * lanes);
}

/// What a kernel file offers.
struct Kernels {
  const char* name = nullptr;
  int lanes = 0, float_lanes = 0;
  void (*sums)(const PopulationJob<double>&) = nullptr;
  void (*float_sums)(const PopulationJob<float>&) = nullptr;
  void (*sines)(const double* angles, int count, double* cosines, double* sines) = nullptr;
  void (*errors)(const PointsJob&) = nullptr;
  double (*jacobian)(const JacobianJob&) = nullptr;  ///< returns the sum of the squared residuals
};

extern const Kernels portable_kernels;
#if defined(__x86_64__)
extern const Kernels avx2_kernels, avx512_kernels;
#endif

/// The fastest that this processor runs.
const Kernels& best_kernels();

/// All that this processor runs, the portable ones first.
struct KernelList {
  const Kernels* kernels[3] = {};
  int count = 0;
};
KernelList runnable_kernels();

}  // namespace kinfer::batch
