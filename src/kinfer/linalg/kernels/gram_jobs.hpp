// SPDX-License-Identifier: Apache-2.0
// JᵀJ and Jᵀr, accumulated over chunks of rows: sizes and plain structs shared by the kernels and their callers.
#pragma once

#include <cstddef>

namespace kinfer::batch {

/// The products of JᵀJ are computed in tiles that fill the registers, those of Jᵀr in strips.
inline constexpr int tile_height = 4, strip_width = 12;
[[gnu::always_inline]] constexpr int tile_width(int lanes) {
  return lanes == 8 ? 4 : 3;
}
[[gnu::always_inline]] constexpr int round_up(int count, int to) {
  return (count + to - 1) / to * to;
}
enum class Chunks { one, several };
/// Size of the tile sums that are kept between chunks; of a single tile where there is one chunk.
[[gnu::always_inline]] constexpr int tile_numbers(int columns, Chunks chunks, int lanes) {
  int tiles = 1;
  if (chunks == Chunks::several) {
    tiles = 0;
    for (int i = 0; i < columns; i += tile_height)
      for (int j = 0; j < i + tile_height && j < columns; j += tile_width(lanes)) ++tiles;
  }
  return tiles * tile_height * tile_width(lanes) * lanes;
}
/// Columns of a chunk with padding: the last tiles and strips read beyond the last one, where the residual is.
[[gnu::always_inline]] constexpr int padded_columns(int columns) {
  const int read = round_up(columns, strip_width);
  return read > columns ? read : columns + 1;
}

/// aᵀa and aᵀb of a complete matrix.
struct GramJob {
  const double* a = nullptr;  ///< rows x columns, column by column
  std::ptrdiff_t a_stride = 0;
  const double* b = nullptr;  ///< rows
  int rows = 0, columns = 0;
  double* matrix = nullptr;    ///< lower half of aᵀa, column by column
  double* gradient = nullptr;  ///< aᵀb
  double* workspace = nullptr;
};
inline constexpr int packs_per_chunk = 48;
/// Workspace that a GramJob needs, in doubles.
[[gnu::always_inline]] constexpr std::size_t gram_workspace(int rows, int columns, int lanes) {
  const Chunks chunks = rows > packs_per_chunk * lanes ? Chunks::several : Chunks::one;
  return static_cast<std::size_t>(padded_columns(columns)) * packs_per_chunk * lanes +
         tile_numbers(columns, chunks, lanes) + round_up(columns, strip_width) * lanes;
}

/// The functions of one kernel file.
struct GramKernel {
  int lanes = 0;
  void (*normal_equations)(const GramJob&) = nullptr;
};
extern const GramKernel portable_gram;
#if defined(__x86_64__)
extern const GramKernel avx2_gram, avx512_gram;
#endif
/// The fastest one that this processor supports.
const GramKernel& best_gram_kernel();

}  // namespace kinfer::batch
