// What the batch kernels are told and what they offer: plain numbers, so that a kernel file compiled for one
// instruction set shares no inline function with the rest of the program.
//
// A chain is folded into segments: a constant transform, then a joint's turn about or shift along z of the frame
// reached, and so on to the tool. "Constant" means the same at all poses; it may differ from candidate to candidate.
#pragma once

#include <cstddef>
#include <cstdint>

namespace kinfer::batch {

/// A number of the chain: parameter x[parameter], or a constant where that is negative.
struct Value {
  int parameter = -1;
  double constant = 0.0;        ///< of a parameter: its nominal number
  double cos = 1.0, sin = 0.0;  ///< of the constant, where it is an angle
};

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
  bool varies = false;  ///< with the candidate
  double numbers[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  Value d, a, alpha, theta;         ///< of a link that varies
  const Factor* factors = nullptr;  ///< of a general transform that varies
  int factor_count = 0;
  Move move = Move::none;
  Value gain;            ///< of a movement by gain: x[parameter] − constant is what changed
  int slots_before = 0;  ///< numbers of an item that belong to the movements further outwards
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
  const double* x = nullptr;        ///< unknowns x candidates, column by column
  std::ptrdiff_t x_stride = 0;
  int candidates = 0;
  double* sums = nullptr;
  T* workspace = nullptr;  ///< lanes · (unknowns + 13 segment_count)
};

/// Numbers of workspace that a PointsJob needs.
[[gnu::always_inline]] constexpr std::size_t points_workspace(int unknowns, int segments, int lanes) {
  return static_cast<std::size_t>(3 * (unknowns + lanes) + 13 * segments * (lanes + 1) + lanes);
}

/// Errors of points at one candidate: lanes are points, in blocks of as many.
struct PointsJob {
  const Segment* segments = nullptr;
  int segment_count = 0;
  const Group* groups = nullptr;  ///< items are blocks
  int group_count = 0;
  const double* items = nullptr;  ///< block by block, number by number, lane by lane
  int stride = 0;
  const double* x = nullptr;
  int unknowns = 0;
  double* errors = nullptr;  ///< measured − predicted, 3 x lanes a block
  double* workspace = nullptr;
};

/// The walk from the world to the tool that collects derivatives: lanes are points.
struct Step {
  enum class Kind : std::uint8_t { turn, shift, rotation, turn_joint, shift_joint, record_turn, record_shift };
  Kind kind = Kind::turn;
  int axis = 0;
  double a = 0.0, b = 0.0;  ///< cosine and sine, or length
  double extra_gain = 0.0;  ///< of a joint: by what its gain differs from the one that the items were made with
  int slot = -1;            ///< of the joint's numbers in an item; of what a record is multiplied by, −1: nothing
  int column = -1;          ///< of a record
  double rotation[9] = {};  ///< row by row
};

struct JacobianJob {
  const Step* steps = nullptr;
  int step_count = 0;
  const Group* groups = nullptr;  ///< items are blocks
  int group_count = 0;
  const double* items = nullptr;  ///< as of a PointsJob
  int stride = 0;
  const double* weights = nullptr;  ///< 3 x lanes a block, 1 / sd; 0 where a lane has no point
  int columns = 0;
  const int* idle = nullptr;  ///< columns that no step records
  int idle_count = 0;
  double* residuals = nullptr;  ///< weight · (measured − predicted), 3 x lanes a block
  double* jacobian = nullptr;   ///< of the residuals: column by column, each 3 x lanes a block; null: not stored
  int blocks = 0;
  double* normal = nullptr;  ///< (columns + 1)²: lower half of [J r]ᵀ[J r]; read only where no Jacobian is stored
  double* workspace = nullptr;
};

/// The products of [J r]ᵀ[J r] are made in tiles.
inline constexpr int tile_height = 4, tile_width = 3;
inline constexpr int blocks_in_flight = 2, blocks_a_chunk = 8;
[[gnu::always_inline]] constexpr int tile_numbers(int size) {
  int tiles = 0;
  for (int i = 0; i < size; i += tile_height)
    for (int j = 0; j < i + tile_height && j < size; j += tile_width) ++tiles;
  return tiles * tile_height * tile_width;
}
/// Columns of a chunk: one for the residual, and what the last tiles read beyond.
[[gnu::always_inline]] constexpr int padded_columns(int columns) {
  return columns + 1 + tile_height + tile_width;
}
/// Numbers of workspace that a JacobianJob needs.
[[gnu::always_inline]] constexpr std::size_t jacobian_workspace(int columns, int lanes) {
  return static_cast<std::size_t>(lanes) *
         (columns * 6 * blocks_in_flight + padded_columns(columns) * 3 * blocks_a_chunk + tile_numbers(columns + 1));
}

/// What a kernel file offers.
struct Kernels {
  const char* name = nullptr;
  int lanes = 0, float_lanes = 0;
  void (*sums)(const PopulationJob<double>&) = nullptr;
  void (*float_sums)(const PopulationJob<float>&) = nullptr;
  void (*errors)(const PointsJob&) = nullptr;
  void (*jacobian)(const JacobianJob&) = nullptr;
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
