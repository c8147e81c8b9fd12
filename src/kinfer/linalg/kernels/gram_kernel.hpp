// SPDX-License-Identifier: Apache-2.0
// JᵀJ and Jᵀr, accumulated over chunks of rows. Included by the kernel files only.
#pragma once

#include "kinfer/base/pack_kernel.hpp"
#include "kinfer/linalg/kernels/gram_jobs.hpp"

namespace kinfer::batch {
namespace {  // one copy per kernel file, compiled for its instruction set

/// The sums of four packs over their lanes.
template <class V>
inline void lane_sums(const double* a, const double* b, const double* c, const double* d, double* to) {
  constexpr int lanes = Traits<V>::lanes;
  if constexpr (lanes < 4) {
    to[0] = a[0] + a[1], to[1] = b[0] + b[1], to[2] = c[0] + c[1], to[3] = d[0] + d[1];
  } else {
    using Four = Pack<double, 4>;
    const auto four = [](const double* pack) {
      Four sum = load<Four>(pack);
      for (int half = 4; half < lanes; half += 4) sum += load<Four>(pack + half);
      return sum;
    };
    const Four p = four(a), q = four(b), r = four(c), s = four(d);
    const Four pq = __builtin_shufflevector(p, q, 0, 4, 2, 6) + __builtin_shufflevector(p, q, 1, 5, 3, 7);
    const Four rs = __builtin_shufflevector(r, s, 0, 4, 2, 6) + __builtin_shufflevector(r, s, 1, 5, 3, 7);
    store(to, __builtin_shufflevector(pq, rs, 0, 1, 4, 5) + __builtin_shufflevector(pq, rs, 2, 3, 6, 7));
  }
}

/// Products of all columns with each other and with the residual, not yet summed over the lanes. Column k of a chunk is
/// at chunk + k · stride, the residual after the last one. Tiles and strips read beyond it and discard what they
/// compute from there.
template <class V>
class Gram {
 public:
  static constexpr int lanes = Traits<V>::lanes, tall = tile_height, wide = tile_width(lanes), strip = strip_width;

  Gram(int columns, Chunks chunks, double* sums)
      : columns_(columns), tiles_(sums), strips_(sums + tile_numbers(columns, chunks, lanes)) {
    static_assert(strip % tall == 0 && strip % wide == 0);
  }

  /// Adds the rows of a chunk, `rows` packs of them.
  void add(const double* chunk, std::ptrdiff_t stride, int rows) {
    for_each_tile([&](int i0, int j0, double* tile) { add_tile(chunk, stride, rows, i0, j0, tile); });
    for (int j0 = 0; j0 < columns_; j0 += strip) add_strip(chunk, stride, rows, j0, strips_ + j0 * lanes);
    is_empty_ = false;
  }

  /// Adds the last chunk and writes the lower half of JᵀJ, column by column, and Jᵀr. Each sum is written while it is
  /// in the cache; a single chunk needs one tile and one strip of workspace only.
  void finish(const double* chunk, std::ptrdiff_t stride, int rows, double* matrix, double* gradient) {
    for_each_tile([&](int i0, int j0, double* tile) {
      if (is_empty_) tile = tiles_;
      add_tile(chunk, stride, rows, i0, j0, tile);
      for (int j = 0; j < wide; ++j) write_part(tile, j, i0, j0, matrix);
    });
    for (int j0 = 0; j0 < columns_; j0 += strip) {
      double* sums = is_empty_ ? strips_ : strips_ + j0 * lanes;
      add_strip(chunk, stride, rows, j0, sums);
      write_strip(sums, j0, gradient);
    }
  }

 private:
  /// Writes four numbers of column j0 + j.
  void write_part(const double* tile, int j, int i0, int j0, double* matrix) const {
    static_assert(tall == 4);
    if (j0 + j >= columns_) return;
    const auto product = [&](int i) { return tile + (i * wide + j) * lanes; };
    const auto sum_to = [&](double* to) { lane_sums<V>(product(0), product(1), product(2), product(3), to); };
    double* to = matrix + static_cast<std::ptrdiff_t>(j0 + j) * columns_ + i0;
    if (j0 + j <= i0 && i0 + tall <= columns_) return sum_to(to);
    double sums[tall];
    sum_to(sums);
    for (int i = 0; i < tall; ++i)
      if (i0 + i < columns_ && j0 + j <= i0 + i) to[i] = sums[i];
  }

  void write_strip(const double* sums, int j0, double* gradient) const {
    for (int j = 0; j < strip && j0 + j < columns_; j += 4, sums += 4 * lanes) {
      double four[4];
      lane_sums<V>(sums, sums + lanes, sums + 2 * lanes, sums + 3 * lanes, four);
      for (int k = 0; k < 4 && j0 + j + k < columns_; ++k) gradient[j0 + j + k] = four[k];
    }
  }

  void add_tile(const double* chunk, std::ptrdiff_t stride, int rows, int i0, int j0, double* tile) const {
    add_products<tall, wide>(chunk + i0 * stride, chunk + j0 * stride, stride, rows, tile);
  }
  void add_strip(const double* chunk, std::ptrdiff_t stride, int rows, int j0, double* sums) const {
    add_products<1, strip>(chunk + columns_ * stride, chunk + j0 * stride, stride, rows, sums);
  }

  template <int height, int width>
  void add_products(const double* left, const double* right, std::ptrdiff_t stride, int rows, double* to) const {
    V sum[height][width];
    for (int i = 0; i < height; ++i)
      for (int j = 0; j < width; ++j) sum[i][j] = is_empty_ ? broadcast<V>(0.0) : load<V>(to + (i * width + j) * lanes);
    for (int row = 0; row < rows; ++row, left += lanes, right += lanes) {
      V r[width];
      for (int j = 0; j < width; ++j) r[j] = load<V>(right + j * stride);
      for (int i = 0; i < height; ++i) {
        const V l = load<V>(left + i * stride);
        for (int j = 0; j < width; ++j) sum[i][j] = mul_add(l, r[j], sum[i][j]);
      }
    }
    for (int i = 0; i < height; ++i)
      for (int j = 0; j < width; ++j) store(to + (i * width + j) * lanes, sum[i][j]);
  }

  template <class F>
  void for_each_tile(F&& f) const {
    double* tile = tiles_;
    for (int i0 = 0; i0 < columns_; i0 += tall)
      for (int j0 = 0; j0 < i0 + tall && j0 < columns_; j0 += wide, tile += tall * wide * lanes) f(i0, j0, tile);
  }

  int columns_;
  double *tiles_, *strips_;
  bool is_empty_ = true;
};

/// Copies the rows chunk by chunk to a buffer that stays in the cache, b after the last column.
template <class V>
void normal_equations(const GramJob& job) {
  constexpr int lanes = Traits<V>::lanes, stride = packs_per_chunk * lanes;
  const Chunks chunks = job.rows > stride ? Chunks::several : Chunks::one;
  double* chunk = job.workspace;
  Gram<V> gram(job.columns, chunks, chunk + static_cast<std::ptrdiff_t>(padded_columns(job.columns)) * stride);
  for (int row = 0;; row += stride) {
    const int left = job.rows - row, count = left < stride ? left : stride, packs = (count + lanes - 1) / lanes;
    for (int column = 0; column <= job.columns; ++column) {
      const double* from = (column < job.columns ? job.a + column * job.a_stride : job.b) + row;
      double* to = chunk + static_cast<std::ptrdiff_t>(column) * stride;
      for (int i = 0; i < count; ++i) to[i] = from[i];
      for (int i = count; i < packs * lanes; ++i) to[i] = 0.0;
    }
    if (left <= stride) return gram.finish(chunk, stride, packs, job.matrix, job.gradient);
    gram.add(chunk, stride, packs);
  }
}

}  // namespace
}  // namespace kinfer::batch
